// SPDX-License-Identifier: Apache-2.0
// Pressure and sinkage of a plate pressed into soil:
//
//   p = (k_c / b + k_phi) z^n      [Bekker 1969], as in [Wong 2008, eq. 2.46]
//
// p is the pressure [Pa], z the sinkage [m], b the shorter side of the plate [m]. k_c [N/m^(n+1)],
// k_phi [N/m^(n+2)] and n [-] are properties of the soil (scene::Soil, bekker_*). Ruts, tyre
// patches, the rigid wheel and the laboratory's plate test use this law.
//
// A wheel with slip s carries soil away and sinks k_s times as deep as without slip [Lyasko 2010]:
//
//   k_s = (1 + |s|) / (1 - |s| / 2)
#pragma once

#include "scene/soil.h"

namespace navvy::terramechanics {

/// Returns the modulus k = k_c / b + k_phi [N/m^(n+2)] of the soil under a plate whose shorter side
/// is `width` b [m].
double plate_modulus(const scene::Soil& soil, double width);

/// Returns the pressure [Pa] under a plate of `width` [m] that has sunk by `sinkage` [m] into the
/// soil: k z^n; 0 for a plate above the surface (`sinkage` <= 0).
double plate_pressure(const scene::Soil& soil, double sinkage, double width);

/// Returns the work per unit of area [J/m2] that presses a plate of `width` [m] from the surface to
/// `sinkage` z [m]: k z^(n+1) / (n + 1).
double plate_work(const scene::Soil& soil, double sinkage, double width);

/// Returns the sinkage [m] of a plate of `width` [m] under `pressure` [Pa]; the inverse of
/// plate_pressure(). Returns 0 for a pressure <= 0, or if the modulus of the plate is not positive,
/// as for a soil without Bekker's constants.
double plate_sinkage(const scene::Soil& soil, double pressure, double width);

/// Returns Lyasko's factor k_s [-]: the sinkage of a wheel with slip divided by its sinkage without
/// slip.
///
/// `slip` is -1 to 1 [-]; values beyond this range are clamped. `coefficient` [-] multiplies the
/// slip in numerator and denominator: 1 gives Lyasko's formula, other values fit measured wheels, 0
/// disables the effect. The product of both is limited to 1.6, where the formula is near its pole.
double slip_sinkage(double slip, double coefficient = 1);

}  // namespace navvy::terramechanics
