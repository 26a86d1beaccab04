// SPDX-License-Identifier: Apache-2.0
// A plate pressed into soil: pressure and sinkage.
//
//   p = (k_c / b + k_phi) z^n      [Bekker 1969], as in [Wong 2008, eq. 2.46]
//
// p pressure [Pa], z sinkage [m], b the lesser side of the plate [m]; k_c [N/m^(n+1)], k_phi [N/m^(n+2)] and n [-] are
// the soil's (scene::Soil, bekker_*). Ruts, tyres' patches, the rigid wheel's arc and the laboratory's plate ask here.
#pragma once

#include "scene/soil.h"

namespace navvy::terramechanics {

/// k_c / b + k_phi [N/m^(n+2)] for a plate of `width` b [m].
double plate_modulus(const scene::Soil& soil, double width);

/// The pressure [Pa] that a plate of `width` [m] bears when it has sunk by `sinkage` [m]; 0 above the surface.
double plate_pressure(const scene::Soil& soil, double sinkage, double width);

/// Inverse of plate_pressure: how far [m] the plate sinks under `pressure` [Pa]. 0 without pressure, or in a soil
/// without Bekker's constants.
double plate_sinkage(const scene::Soil& soil, double pressure, double width);

}  // namespace navvy::terramechanics
