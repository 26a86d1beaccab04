// SPDX-License-Identifier: Apache-2.0
// Shear of soil under a rim or track that slips over it.
//
//   tau = (c + p tan phi) (1 - exp(-|j| / K))      [Janosi 1961], as in [Wong 2008, eq. 2.73]
//
// tau shear stress [Pa], p normal pressure [Pa], j shear displacement since the soil was entered
// [m], K [m] the displacement at which 63 % of the strength is mobilised (scene::Soil::janosi_k).
#pragma once

#include "scene/soil.h"
#include "terramechanics/ground_query.h"

namespace navvy::terramechanics {

/// Coulomb's strength of a surface: c + p tan phi.
struct ShearStrength {
  double cohesion = 0;  ///< c, or adhesion on steel [Pa]
  double slope = 0;     ///< tan phi, or tan delta on steel [-]
};

/// Strength between this soil and a bare rim or tool: the one with less friction of the soil's own
/// (residual cohesion with phi) and the steel's (adhesion with delta), as the weaker of two layers
/// slides. Its cohesion goes with it.
ShearStrength rim_strength(const scene::Soil& soil);

/// Strength of a surface of soil under rubber or grousers, which hold the soil between them: phi
/// with the cohesion of its density state, intact at bank density and above, loose once swollen, in
/// proportion between. Nothing on a firm floor.
ShearStrength surface_strength(const SoilState& ground);

/// Share of the strength that a shear displacement mobilises, 0 to 1: 1 - exp(-|j| / K).
double mobilised_share(double displacement, double janosi_k);

/// Shear stress [Pa] under `pressure` [Pa] after `displacement` [m], with the displacement's sign.
double shear_stress(const ShearStrength& strength, double pressure, double displacement,
                    double janosi_k);

}  // namespace navvy::terramechanics
