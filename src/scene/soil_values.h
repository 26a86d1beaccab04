// SPDX-License-Identifier: Apache-2.0
// Rules for the values of a soil, shared by scene reader, solver and laboratory.
#pragma once

#include <optional>
#include <vector>

#include "core/error.h"
#include "scene/soil.h"

namespace navvy::scene {

/// One numerical parameter of a soil; the name ends in the unit that files use.
using SoilValue = NamedNumber;
/// Returns all numerical parameters of `soil` with their element names. The returned pointers refer
/// to `soil`.
std::vector<SoilValue> soil_values(Soil& soil);

/// Returns the mass [kg] of the heaviest particle that can form from bank soil in cells with the
/// edge `cell` [m]. A column is divided into slices that are at most 3/4 of a cell thick, and each
/// slice into four particles; the factor 1 / 0.8 accounts for ruts, in which soil is denser than in
/// the bank. The mass must fit into 32 bits of kMassQuantum.
inline double heaviest_particle(const Soil& soil, double cell) {
  return soil.bank_density * cell * cell * cell * 0.75 / 0.8 / 4;
}

/// Returns the default Young's modulus [Pa] of a soil with this cohesion [Pa]: the larger of 1 MPa
/// and 200 x cohesion. With a lower modulus, sand keeps its strength, but cohesive soil rebounds
/// and fails before a tool meets its full strength [docs/soil.md, stiffness].
double default_stiffness(double cohesion);

/// Updates Young's modulus after the cohesion has been changed from the value `before` [Pa]: a
/// default modulus is replaced by that of the new cohesion; any other value is kept.
void follow_cohesion(Soil& soil, double before);

/// Returns the default cohesion [Pa] of remoulded soil at its loose density: one fifth of the
/// residual cohesion `residual` [Pa]. Heaps of loam with a residual cohesion of 1.5 kPa then have
/// slopes of 33 to 45 deg, like real spoil; with the full residual cohesion they would have 50 to
/// 70 deg [docs/soil.md, cohesion].
double default_loose_cohesion(double residual);

/// Updates the loose cohesion after the residual cohesion has been changed from the value `before`
/// [Pa]: a default is replaced by that of the new residual cohesion; any other value is kept.
void follow_residual_cohesion(Soil& soil, double before);

/// Updates the friction angle of a soil whose angle is the result of another test than plane
/// strain, from that result and the dilatancy angle. Returns a fault, and leaves the angle as it
/// is, if phi would be above the limit [docs/soil.md, friction angles].
std::optional<Fault> follow_friction_test(Soil& soil);

/// Returns the plastic shear [-] assigned to soil that has slid or was dug; 1 % of its bonds is
/// then left.
inline float remoulded_shear(const Soil& soil) {
  return 9 * static_cast<float>(soil.remoulding_strain);
}

/// Returns a warning if Young's modulus is below 100 x cohesion, otherwise nothing. The warning
/// gives the fraction of the soil's strength that a blade meets, the travel after which it does so,
/// and the computing cost of the default modulus. Such a soil can still be used.
std::optional<Fault> too_soft(const Soil& soil);

/// Returns one fault for each violated relation between two values of the soil. `element` of a
/// fault is "soil[NAME]/" followed by the element name of the value.
std::vector<Fault> check_relations(const Soil& soil);

/// Returns one fault for each value that is out of range and for each violated relation. The faults
/// contain no file name.
std::vector<Fault> check_soil(const Soil& soil);

}  // namespace navvy::scene
