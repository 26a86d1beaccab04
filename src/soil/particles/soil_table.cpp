// SPDX-License-Identifier: Apache-2.0
#include "soil/particles/soil_table.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/error.h"
#include "scene/friction.h"
#include "scene/soil_values.h"

namespace navvy::soil {
namespace {

/// Pressure that no soil reaches [Pa].
constexpr double kNeverCompacts = 1e30;
/// Density of quartz, for the inertial number [kg/m3].
constexpr double kGrainDensity = 2650;

}  // namespace

double most_mixing(double dt, const SchemeConstants& scheme) {
  return std::min(1.0, dt / scheme.min_mixing_time);
}
double packed_mass(double densest, double cell, const SchemeConstants& scheme) {
  return scheme.crowding_threshold * densest * cell * cell * cell;
}
double filled_mass(double densest, double cell, const SchemeConstants& scheme) {
  return densest * cell * cell * cell / scheme.crowding_threshold;
}

LawConstants law_constants(const scene::Soil& soil, double cell, const SchemeConstants& scheme) {
  LawConstants k;
  k.bulk = soil.young_modulus / (3 * (1 - 2 * soil.poisson));
  k.shear = soil.young_modulus / (2 * (1 + soil.poisson));
  k.alpha = std::sin(soil.friction_angle);
  // Without swell soil has no loose density.
  const bool swells = soil.swell > 1;
  const double loose =
      swells ? std::min(soil.loose_cohesion, soil.residual_cohesion) : soil.residual_cohesion;
  k.k_loose = loose * std::cos(soil.friction_angle);
  k.k_dense = (soil.residual_cohesion - loose) * std::cos(soil.friction_angle);
  k.k_bond = (soil.cohesion - soil.residual_cohesion) * std::cos(soil.friction_angle);
  k.dense_offset = swells ? soil.swell / (soil.swell - 1) : 1;
  k.inv_range = swells ? 1 / (soil.swell - 1) : 0;
  k.inv_remould = 1 / soil.remoulding_strain;
  k.inv_opening = 1 / soil.opening_strain;
  k.static_share = soil.static_friction_share;
  k.viscosity = scheme.shear_damping * soil.bank_density * sound_speed(soil) * cell;
  k.swell = soil.swell;
  k.loosening = (soil.swell - 1) / soil.loosening_strain;
  // In plane strain without elastic strain: volume strain / largest shear strain = sin psi, and
  // Mohr-Coulomb's radius for phi [docs/soil.md, dilatancy].
  k.dilatancy = soil.swell > 1 ? scene::dilatancy_ratio(soil.dilatancy_angle) : 0;
  k.matched = scene::dilatant_match(k.alpha, k.dilatancy);
  k.alpha_fast = std::max(0.0, std::sin(soil.fast_friction_angle) - k.alpha);
  k.grain = soil.grain_diameter * std::sqrt(kGrainDensity);
  k.inertial = soil.inertial_number;
  k.cap = soil.compaction_pressure > 0 ? soil.compaction_pressure : kNeverCompacts;
  k.cap_growth = 1 / soil.compaction_strain;
  return k;
}

double sound_speed(const scene::Soil& soil) {
  const double bulk = soil.young_modulus / (3 * (1 - 2 * soil.poisson));
  const double shear = soil.young_modulus / (2 * (1 + soil.poisson));
  return std::sqrt((bulk + 4 * shear / 3) / soil.bank_density);
}

bool needs_extended_law(const std::vector<scene::Soil>& soils) {
  return std::any_of(soils.begin(), soils.end(), [](const scene::Soil& soil) {
    return soil.dilatancy_angle > 0 || soil.fast_friction_angle > soil.friction_angle ||
           soil.compaction_pressure > 0;
  });
}

std::vector<SoilRow> soil_table(const std::vector<scene::Soil>& soils, double cell,
                                const SchemeConstants& scheme) {
  std::vector<Fault> faults;
  for (const scene::Soil& soil : soils)
    for (Fault& fault : scene::check_soil(soil)) faults.push_back(std::move(fault));
  if (!faults.empty()) throw InputError(faults);
  std::vector<SoilRow> table(soils.size());
  for (std::size_t i = 0; i < soils.size(); ++i) {
    const LawConstants law = law_constants(soils[i], cell, scheme);
#define ROW_CONSTANT(name) table[i].name = static_cast<float>(law.name);
    ALL_LAW_CONSTANTS(ROW_CONSTANT)
#undef ROW_CONSTANT
    table[i].inv_density = static_cast<float>(1 / soils[i].bank_density);
    table[i].adhesion = static_cast<float>(soils[i].adhesion);
    table[i].tool_friction = static_cast<float>(std::tan(soils[i].tool_friction_angle));
  }
  return table;
}

}  // namespace navvy::soil
