// SPDX-License-Identifier: Apache-2.0
// Shear of soil under a rim or track that slips over it:
//
//   tau = (c + p tan phi) (1 - exp(-|j| / K))      [Janosi 1961], as in [Wong 2008, eq. 2.73]
//
// tau is the shear stress [Pa], p the normal pressure [Pa], j the shear displacement since the soil
// was entered [m], K the displacement at which 63 % of the strength is mobilised [m]
// (scene::Soil::janosi_k).
#pragma once

#include "scene/soil.h"
#include "terramechanics/ground_query.h"

namespace navvy::terramechanics {

/// Coulomb strength of a surface: c + p tan phi.
struct ShearStrength {
  /// Cohesion c, or adhesion on steel [Pa].
  double cohesion = 0;
  /// tan phi, or tan delta on steel [-].
  double slope = 0;
};

/// Returns the strength between this soil and a bare rim or tool. The weaker of two layers slides:
/// the soil itself (residual cohesion with phi) or the steel surface (adhesion with delta),
/// whichever has less friction.
ShearStrength rim_strength(const scene::Soil& soil);

/// Returns the strength of a soil surface under rubber or grousers, which hold the soil between
/// them: phi with the cohesion of its density, intact at bank density and above, loose once
/// swollen, interpolated in between. Zero on a firm floor.
ShearStrength surface_strength(const SoilState& ground);

/// Returns the share of the strength that a displacement mobilises, 0 to 1: 1 - exp(-|j| / K).
double mobilised_share(double displacement, double janosi_k);

/// Returns the shear stress [Pa] under `pressure` [Pa] after `displacement` [m], with the
/// displacement's sign.
double shear_stress(const ShearStrength& strength, double pressure, double displacement,
                    double janosi_k);

}  // namespace navvy::terramechanics
