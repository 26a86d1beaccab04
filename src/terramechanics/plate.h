// SPDX-License-Identifier: Apache-2.0
// Pressure and sinkage of a plate pressed into soil:
//
//   p = (k_c / b + k_phi) z^n      [Bekker 1969], as in [Wong 2008, eq. 2.46]
//
// p is the pressure [Pa], z the sinkage [m], b the lesser side of the plate [m]; k_c [N/m^(n+1)],
// k_phi [N/m^(n+2)] and n [-] are the soil's (scene::Soil, bekker_*). Ruts, tyre patches, the rigid
// wheel and the laboratory's plate use it.
//
// A slipping wheel carries soil away and sinks k_s times as deep [Lyasko 2010]:
//
//   k_s = (1 + |s|) / (1 - |s| / 2)
#pragma once

#include "scene/soil.h"

namespace navvy::terramechanics {

/// Returns k_c / b + k_phi [N/m^(n+2)] for a plate of `width` b [m].
double plate_modulus(const scene::Soil& soil, double width);

/// Returns the pressure [Pa] on a plate of `width` [m] at a sinkage of `sinkage` [m]; 0 above the
/// surface.
double plate_pressure(const scene::Soil& soil, double sinkage, double width);

/// Returns the work per area [J/m2] of pressing the plate to `sinkage` [m]: k z^(n+1) / (n + 1).
double plate_work(const scene::Soil& soil, double sinkage, double width);

/// Returns the sinkage [m] of the plate under `pressure` [Pa], the inverse of plate_pressure. 0
/// without pressure, or in a soil without Bekker's constants.
double plate_sinkage(const scene::Soil& soil, double pressure, double width);

/// Returns k_s [-], the sinkage of a wheel with this slip (-1 to 1) over its sinkage without slip.
/// `coefficient` multiplies the slip in both places; 1 is Lyasko's value, measured wheels have
/// their own. A slip beyond 1 counts as 1.
double slip_sinkage(double slip, double coefficient = 1);

}  // namespace navvy::terramechanics
