// SPDX-License-Identifier: Apache-2.0
// Constants of a world's soils as the kernels read them.
#pragma once

#include <vector>

#include "scene/scene.h"
#include "soil/law_constants.h"
#include "soil/scheme_constants.h"

namespace navvy::soil {

/// Returns the speed of compression waves in a soil [m/s].
double sound_speed(const scene::Soil& soil);

/// Returns the largest share by which a particle's J / J0 relaxes to the mean of its cell in a step
/// of `dt` [s]. It applies to fast deformation; slower soil mixes less [docs/soil.md, mixing].
double most_mixing(double dt, const SchemeConstants& scheme = kScheme);

/// Returns the node mass, divided by the node's free fraction, above which soil with J = 1 counts
/// as crowded [kg] [docs/soil.md, crowding]. `densest`: largest bank density of the scene [kg/m3];
/// `cell`: edge of a cell [m]. Soil lighter than the densest is corrected too little, never too
/// much.
double packed_mass(double densest, double cell, const SchemeConstants& scheme = kScheme);
/// Returns the node mass, divided by the node's free fraction, from which the nodes indicate closed
/// soil (J <= J0) if J = 1 [kg] [docs/soil.md, opening]. Parameters as for packed_mass.
double filled_mass(double densest, double cell, const SchemeConstants& scheme = kScheme);

/// Returns true if the soil law must be compiled with LAW_EXTENDED (kernels/soil/law.h), because at
/// least one soil uses dilatancy, mu(I) or compaction.
bool needs_extended_law(const std::vector<scene::Soil>& soils);

/// Returns the constants of each soil for the kernels, in the order of the world's soils. `cell`:
/// edge of a cell [m].
/// @throws InputError listing every soil property with which the soil law cannot compute.
std::vector<SoilRow> soil_table(const std::vector<scene::Soil>& soils, double cell,
                                const SchemeConstants& scheme = kScheme);

/// Constants of the soil law in double precision, derived from a soil's properties;
/// kernels/soil/law_constants.h describes each of them. The constants of the kernels and of the
/// double-precision twin are computed from these.
#define LAW_DOUBLE(name) double name = 0;
struct LawConstants {
  ALL_LAW_CONSTANTS(LAW_DOUBLE)
};
#undef LAW_DOUBLE
/// Returns the constants of the soil law for one soil. `cell`: edge of a cell [m].
LawConstants law_constants(const scene::Soil& soil, double cell,
                           const SchemeConstants& scheme = kScheme);

}  // namespace navvy::soil
