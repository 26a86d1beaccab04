// SPDX-License-Identifier: Apache-2.0
#include "soil/particles/particle_to_grid.h"

#include <string>

#include "soil/particles/buffers.h"
#include "soil/particles/schedule.h"
#include "soil/particles/soil_table.h"

namespace navvy::soil {

ParticleToGrid::ParticleToGrid(device::Device& device, bool extended_law)
    : device_(device),
      program_(device, kernel_path(device, "particle_to_grid"),
               extended_law ? std::vector{device::define("LAW_EXTENDED", 1)}
                            : std::vector<std::string>{}),
      kernel_(program_, "particle_to_grid") {}

// Contents are rewritten by every scatter, so room is all they need.
void ParticleToGrid::set_blocks(std::size_t particle_blocks, int tiles) {
  ensure(device_, tiles_, static_cast<std::size_t>(tiles) * 4 * TILE_NODES);
  ensure(device_, used_, particle_blocks);
}

void ParticleToGrid::enqueue(ParticleStore& store, device::Buffer<Report>& report, double dt,
                             double cell, bool hold) {
  kernel_
      .args(store.state(), store.capacity(), store.soils(), store.particle_blocks_buffer(), tiles_,
            used_, report, static_cast<float>(dt), static_cast<float>(cell),
            static_cast<float>(dt / mixing_strain()), static_cast<float>(most_mixing(dt)),
            hold ? 0.0f : 1.0f)
      .enqueue_groups(store.particle_blocks().size());
}

}  // namespace navvy::soil
