// SPDX-License-Identifier: Apache-2.0
// A plate pressed into soil: pressure and sinkage.
//
//   p = (k_c / b + k_phi) z^n      [Bekker 1969], as in [Wong 2008, eq. 2.46]
//
// p pressure [Pa], z sinkage [m], b the lesser side of the plate [m]; k_c [N/m^(n+1)], k_phi
// [N/m^(n+2)] and n [-] are the soil's (scene::Soil, bekker_*). Ruts, tyres' patches, the rigid
// wheel's arc and the laboratory's plate ask here.
//
// Under a wheel that slips, soil is carried away and it sinks k_s times as deep [Lyasko 2010]:
//
//   k_s = (1 + |s|) / (1 - |s| / 2)
#pragma once

#include "scene/soil.h"

namespace navvy::terramechanics {

/// k_c / b + k_phi [N/m^(n+2)] for a plate of `width` b [m].
double plate_modulus(const scene::Soil& soil, double width);

/// The pressure [Pa] that a plate of `width` [m] bears when it has sunk by `sinkage` [m]; 0 above
/// the surface.
double plate_pressure(const scene::Soil& soil, double sinkage, double width);

/// Work per area [J/m2] of pressing such a plate down to `sinkage` [m]: k z^(n+1) / (n + 1).
double plate_work(const scene::Soil& soil, double sinkage, double width);

/// Inverse of plate_pressure: how far [m] the plate sinks under `pressure` [Pa]. 0 without
/// pressure, or in a soil without Bekker's constants.
double plate_sinkage(const scene::Soil& soil, double pressure, double width);

/// k_s of a wheel with this slip [-], -1 to 1: sinkage over that without slip. `coefficient`
/// multiplies the slip in both places; 1 is Lyasko's, measured wheels have their own. A slip beyond
/// 1 counts as 1.
double slip_sinkage(double slip, double coefficient = 1);

}  // namespace navvy::terramechanics
