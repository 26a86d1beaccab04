// SPDX-License-Identifier: Apache-2.0
// The soils of a world as the kernels read them.
#pragma once

#include <vector>

#include "scene/world.h"

namespace navvy::soil {

/// Speed of compression waves [m/s].
double sound_speed(const scene::Soil& soil);

/// Time over which J / J0 of particles in one cell relaxes to the cell's mean [s].
double mixing_time();

/// Mean mass of the nodes around a particle [kg] that means "as dense as J = 1 allows", for the densest soil of the
/// scene: soil whose J promises more room than the nodes show closes over `closing_time` [s].
double packed_mass(double densest, double cell);
double closing_time();

/// SOIL_WORDS floats per soil (kernels/soil/layout.h). `cell` in m.
/// @throws InputError for soils the law cannot compute: every fault is listed.
std::vector<float> soil_table(const std::vector<scene::Soil>& soils, double cell);

/// Shared by the table and the reference: law constants derived from a soil.
struct LawConstants {
  double bulk, shear, alpha, k_residual, k_bond, inv_remould, inv_opening, viscosity, swell, loosening;
};
LawConstants law_constants(const scene::Soil& soil, double cell);

}  // namespace navvy::soil
