// SPDX-License-Identifier: Apache-2.0
// The active soil of a world as named arrays.
#pragma once

#include "scene/particle_table.h"
#include "sim/world.h"

namespace navvy::sim {

/// Returns all active particles of the world with their current positions, ordered by ID, which is
/// the same order in every repetition of a run. Waits for the device; costs a pass over all
/// particles.
///
/// Masses and positions are exact, velocities and the state of the soil law have the float32 values
/// of the device. Density and stress are computed from them in double precision and rounded to
/// float32: density = bank density / J, stress = s - p I with the deviatoric stress s of the
/// particle and the pressure p = K max(0, 1 - J / J0) of its bulk modulus K. The viscous part acts
/// during a step only and is not part of a particle's state [docs/soil.md, stress update].
scene::ParticleTable read_particles(const World& world);

}  // namespace navvy::sim
