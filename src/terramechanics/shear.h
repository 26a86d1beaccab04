// SPDX-License-Identifier: Apache-2.0
// Shear of soil under a rim or track that slips over it:
//
//   tau = (c + p tan phi) (1 - exp(-|j| / K))      [Janosi 1961], as in [Wong 2008, eq. 2.73]
//
// tau is the shear stress [Pa], p the normal pressure [Pa], j the shear displacement since the rim
// or shoe entered the soil [m], and K the displacement at which 63 % of the strength is mobilised
// [m] (scene::Soil::janosi_k). c + p tan phi is the strength.
#pragma once

#include "scene/soil.h"
#include "terramechanics/ground_query.h"

namespace navvy::terramechanics {

/// Coulomb strength of a sliding surface: c + p tan phi at the normal pressure p.
struct ShearStrength {
  /// Cohesion c of the soil, or its adhesion to steel [Pa].
  double cohesion = 0;
  /// Friction coefficient [-]: tan phi of the soil, or tan delta of soil on steel.
  double slope = 0;
};

/// Returns the strength of the contact between `soil` and a smooth steel rim or tool. Whichever has
/// less friction slides: the soil itself (residual cohesion and phi) or the interface with the
/// steel (adhesion and delta).
ShearStrength rim_strength(const scene::Soil& soil);

/// Returns the strength of a soil surface under rubber or grousers, where soil slides on soil.
///
/// The friction is phi. The cohesion depends on the volume ratio: it has the intact value at bank
/// density and denser, the loose value in fully swollen soil, and is interpolated in between.
/// Returns zero strength on a firm floor.
ShearStrength surface_strength(const SoilState& ground);

/// Returns the share of the strength, 0 to 1, that a shear displacement j = `displacement` [m]
/// mobilises: 1 - exp(-|j| / K), with K = `janosi_k` [m].
double mobilised_share(double displacement, double janosi_k);

/// Returns the shear stress [Pa] of a surface of this `strength` under the normal `pressure` [Pa]
/// after a shear displacement of `displacement` [m]. The stress has the sign of the displacement.
/// `janosi_k` is the shear modulus K [m].
double shear_stress(const ShearStrength& strength, double pressure, double displacement,
                    double janosi_k);

}  // namespace navvy::terramechanics
