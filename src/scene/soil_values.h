// SPDX-License-Identifier: Apache-2.0
// The numbers of a soil by their names in scene files, and the one table of what each may be: the
// scene reader, the solver and the laboratory's files all go by it.
#pragma once

#include <optional>
#include <vector>

#include "core/error.h"
#include "scene/soil.h"

namespace navvy::scene {

/// One number of a soil. Range and text are in the unit that its name ends in; value in the struct
/// = written x factor. Units stand in the name, so a file cannot mean another one.
struct SoilValue {
  const char* name;
  double Soil::*value;
  double low,
      /// Both allowed; what any soil stays within, snow, lunar dust and the laboratory's weights
      /// included.
      high;
  double factor = 1;

  double written(const Soil& soil) const { return soil.*value / factor; }
};

/// Every number of a soil but its colour, in the order of scenarios/README.md. Built once; the
/// pointers into Soil are good for any soil.
const std::vector<SoilValue>& soil_values();

/// The heaviest particle that bank soil becomes in cells of this edge [kg]: slices are up to 3/4 of
/// a cell thick, four in plan, and soil may be denser than bank by the ruts' limit. Masses of
/// particles are counted in 32 bits of kMassQuantum.
inline double heaviest_particle(const Soil& soil, double cell) {
  return soil.bank_density * cell * cell * cell * 0.75 / 0.8 / 4;
}

/// Young's modulus of a soil for which none is given [Pa]: max(1 MPa, 200 x cohesion). A softer one
/// makes sand no weaker, but cohesive soil yields by rebound before a tool has felt its strength
/// [docs/soil.md, stiffness].
double default_stiffness(double cohesion);

/// Whoever changes the cohesion of a soil from `before` [Pa] calls this where no stiffness is given
/// beside it: the default follows the cohesion, a stiffness of its own stays.
void follow_cohesion(Soil& soil, double before);

/// Cohesion of remoulded soil at its loose density, where none is given [Pa]: a fifth of the
/// residual one. Loam of 1.5 kPa then lies in heaps of 33 to 45 deg, as spoil does; with the whole
/// of it they stand at 50 to 70 [docs/soil.md, cohesion].
double default_loose_cohesion(double residual);

/// Whoever changes the residual cohesion of a soil from `before` [Pa] calls this where no loose one
/// is given beside it.
void follow_residual_cohesion(Soil& soil, double before);

/// Plastic shear [-] of soil that has slid or was dug: a hundredth of its bonds is left.
inline float remoulded_shear(const Soil& soil) {
  return 9 * static_cast<float>(soil.remoulding_strain);
}

/// A warning for soil softer than 100 x its cohesion: what share of its strength a blade feels,
/// after how much travel, and what the default would cost. It runs all the same.
std::optional<Fault> too_soft(const Soil& soil);

/// What a soil's numbers must be to each other; the element of a fault is "soil[name]/" and the
/// number's name.
std::vector<Fault> check_relations(const Soil& soil);

/// What is outside the table, or not a number, and broken relations; empty when all is in order.
/// Faults name no file: whoever read the soil knows where it stood.
std::vector<Fault> check_soil(const Soil& soil);

}  // namespace navvy::scene
