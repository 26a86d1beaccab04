// SPDX-License-Identifier: Apache-2.0
// Rules for the values of a soil, shared by scene reader, solver and laboratory.
#pragma once

#include <optional>
#include <vector>

#include "core/error.h"
#include "scene/soil.h"

namespace navvy::scene {

/// A numeric parameter of a soil, with the name of its scene element.
using SoilValue = NamedNumber;
/// Returns all numeric parameters of `soil`. The results point into `soil`, so they can be used to
/// change it.
std::vector<SoilValue> soil_values(Soil& soil);

/// Returns the maximum mass [kg] of a particle of `soil` if the edge of a cell is `cell` [m]. A
/// particle contains up to a quarter of a slice that is 3/4 of a cell thick, and ruts may compact
/// soil beyond its bank density. The limit of 32 bits for masses (in units of kMassQuantum) applies
/// to it.
inline double heaviest_particle(const Soil& soil, double cell) {
  return soil.bank_density * cell * cell * cell * 0.75 / 0.8 / 4;
}

/// Returns the default of Young's modulus [Pa] for a soil with this cohesion [Pa]: max(1 MPa, 200 x
/// cohesion). With a softer value, sand remains as strong, but cohesive soil rebounds before a tool
/// meets its full strength [docs/soil.md, stiffness].
double default_stiffness(double cohesion);

/// Updates Young's modulus after the soil's cohesion was changed; `before` is the old cohesion
/// [Pa]. Only a modulus equal to the old default changes, to the new default.
void follow_cohesion(Soil& soil, double before);

/// Returns the default cohesion [Pa] of remoulded soil at its loose density: a fifth of the
/// residual cohesion [Pa]. With it, heaps of loam (residual cohesion 1.5 kPa) have slopes of 33 to
/// 45 deg, as real spoil heaps do; with the full residual cohesion they have 50 to 70 deg
/// [docs/soil.md, cohesion].
double default_loose_cohesion(double residual);

/// Updates the loose cohesion after the soil's residual cohesion was changed; `before` is the old
/// residual cohesion [Pa]. Only a loose cohesion equal to the old default changes, to the new
/// default.
void follow_residual_cohesion(Soil& soil, double before);

/// Returns the plastic shear strain [-] assigned to soil that has slid or was dug. At this strain 1
/// % of the initial bonds are left.
inline float remoulded_shear(const Soil& soil) {
  return 9 * static_cast<float>(soil.remoulding_strain);
}

/// Returns a warning if the soil's Young's modulus is below 100 x its cohesion. The warning states
/// which share of the soil's strength a blade meets, after which displacement, and what the default
/// modulus would cost. Returns nothing for other soils.
std::optional<Fault> too_soft(const Soil& soil);

/// Checks rules between several parameters, such as residual cohesion <= cohesion. Returns one
/// fault per broken rule; its element is "soil[NAME]/PARAMETER", its file is empty.
std::vector<Fault> check_relations(const Soil& soil);

/// Checks all ranges and the rules of check_relations. Returns one fault per violation, without a
/// file name.
std::vector<Fault> check_soil(const Soil& soil);

}  // namespace navvy::scene
