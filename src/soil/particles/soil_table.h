// SPDX-License-Identifier: Apache-2.0
// Soils of a world as the kernels read them.
#pragma once

#include <vector>

#include "scene/scene.h"
#include "soil/law_constants.h"
#include "soil/scheme_constants.h"

namespace navvy::soil {

/// Returns the speed of compression waves [m/s].
double sound_speed(const scene::Soil& soil);

/// Returns the largest share by which a particle's J / J0 moves to its cell's mean in a step of
/// `dt` [s], however fast it deforms [docs/soil.md, mixing].
double most_mixing(double dt, const SchemeConstants& scheme = kScheme);

/// Returns the mass per free volume of the nodes around a particle [kg] above which soil counts as
/// crowded at J = 1, for the densest soil of the scene [docs/soil.md, crowding]. Lighter soil
/// beside the densest is corrected too little, never too much. `densest` in kg/m3, `cell` in m.
double packed_mass(double densest, double cell, const SchemeConstants& scheme = kScheme);
/// Returns the mass of that kind [kg] from which on the nodes show soil that is closed at J = 1
/// [docs/soil.md, opening].
double filled_mass(double densest, double cell, const SchemeConstants& scheme = kScheme);

/// Returns true if the law must be built with LAW_EXTENDED (kernels/soil/law.h): a soil has
/// dilatancy, mu(I) or compaction.
bool needs_extended_law(const std::vector<scene::Soil>& soils);

/// Returns the constants of each soil for the kernels, in the order of the world. `cell` in m.
/// @throws InputError with every fault of soils that the law cannot compute.
std::vector<SoilRow> soil_table(const std::vector<scene::Soil>& soils, double cell,
                                const SchemeConstants& scheme = kScheme);

/// Constants of the law (described in kernels/soil/law_constants.h), derived from a soil. The table
/// and the double twin are made of them.
#define LAW_DOUBLE(name) double name = 0;
struct LawConstants {
  ALL_LAW_CONSTANTS(LAW_DOUBLE)
};
#undef LAW_DOUBLE
LawConstants law_constants(const scene::Soil& soil, double cell,
                           const SchemeConstants& scheme = kScheme);

}  // namespace navvy::soil
