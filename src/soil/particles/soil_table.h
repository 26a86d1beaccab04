// SPDX-License-Identifier: Apache-2.0
// The soils of a world as the kernels read them.
#pragma once

#include <vector>

#include "scene/scene.h"
#include "soil/law_constants.h"

namespace navvy::soil {

/// Speed of compression waves [m/s].
double sound_speed(const scene::Soil& soil);

/// Strain over which J / J0 of a particle relaxes to its cell's mean, and the largest share of the
/// way that it goes in a step of `dt` [s], however fast it deforms [docs/soil.md, mixing].
double mixing_strain();
double most_mixing(double dt);

/// Mean mass per room of the nodes around a particle [kg] from which on soil counts as crowded at J
/// = 1, for the densest soil of the scene: where min(J, J0) promises more room than the nodes show,
/// particles are moved apart, all of the way over a shear strain of `crowding_shear`, at most
/// `farthest_apart` [cells] a transfer. Lighter soil beside the densest is corrected too little,
/// never too much.
double packed_mass(double densest, double cell);
/// Such a mass [kg] from which on the nodes show soil closed at J = 1; where J says that it is open
/// a little, noise has opened it, and by `closing_share` a transfer it closes again.
double filled_mass(double densest, double cell);
double closing_share();
double crowding_shear();
double farthest_apart();

/// Whether the law must be built with LAW_EXTENDED (kernels/soil/law.h): a soil has dilatancy,
/// mu(I) or compaction.
bool needs_extended_law(const std::vector<scene::Soil>& soils);

/// What the kernels read of each soil, in the order of the world. `cell` in m.
/// @throws InputError for soils the law cannot compute: every fault is listed.
std::vector<SoilRow> soil_table(const std::vector<scene::Soil>& soils, double cell);

/// The constants of the law (kernels/soil/law_constants.h says what each is), derived from a soil;
/// what the table and the double twin are made of.
#define LAW_DOUBLE(name) double name = 0;
struct LawConstants {
  ALL_LAW_CONSTANTS(LAW_DOUBLE)
};
#undef LAW_DOUBLE
LawConstants law_constants(const scene::Soil& soil, double cell);

}  // namespace navvy::soil
