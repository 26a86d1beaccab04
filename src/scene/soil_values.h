// SPDX-License-Identifier: Apache-2.0
// Rules for the values of a soil, shared by scene reader, solver and laboratory.
#pragma once

#include <optional>
#include <vector>

#include "core/error.h"
#include "scene/soil.h"

namespace navvy::scene {

/// One number of a soil. Its name ends in the unit of the file.
using SoilValue = NamedNumber;
/// Returns every parameter of `soil` that is a number, by its element name. They refer to `soil`.
std::vector<SoilValue> soil_values(Soil& soil);

/// Returns the mass of the heaviest particle that bank soil becomes in cells of edge `cell` [m], in
/// kg. Slices are up to 3/4 of a cell thick, four in plan, and ruts may compact soil beyond its
/// bank density. Masses of particles are counted in 32 bits of kMassQuantum.
inline double heaviest_particle(const Soil& soil, double cell) {
  return soil.bank_density * cell * cell * cell * 0.75 / 0.8 / 4;
}

/// Returns Young's modulus [Pa] of a soil that gives none: max(1 MPa, 200 x cohesion). A softer
/// value leaves sand as strong, but cohesive soil then yields by rebound before a tool meets its
/// full strength [docs/soil.md, stiffness].
double default_stiffness(double cohesion);

/// Updates the stiffness after the cohesion has changed from `before` [Pa]: a default follows the
/// cohesion, a value of the soil's own stays.
void follow_cohesion(Soil& soil, double before);

/// Returns the cohesion [Pa] of remoulded soil at its loose density where none is given: a fifth of
/// the residual one. Heaps of loam with 1.5 kPa then stand at 33 to 45 deg, as spoil does; with all
/// of it they stand at 50 to 70 deg [docs/soil.md, cohesion].
double default_loose_cohesion(double residual);

/// Updates the loose cohesion after the residual one has changed from `before` [Pa], as
/// `follow_cohesion` does.
void follow_residual_cohesion(Soil& soil, double before);

/// Returns the plastic shear [-] of soil that has slid or was dug: 1 % of its bonds is left.
inline float remoulded_shear(const Soil& soil) {
  return 9 * static_cast<float>(soil.remoulding_strain);
}

/// Returns a warning for soil softer than 100 x its cohesion: the share of its strength that a
/// blade meets, after which travel, and the cost of the default. The soil can be used.
std::optional<Fault> too_soft(const Soil& soil);

/// Returns the broken relations between the values of a soil. The element of a fault is
/// "soil[name]/" and the name of the value.
std::vector<Fault> check_relations(const Soil& soil);

/// Returns all values out of range and broken relations. The faults name no file.
std::vector<Fault> check_soil(const Soil& soil);

}  // namespace navvy::scene
