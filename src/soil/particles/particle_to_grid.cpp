// SPDX-License-Identifier: Apache-2.0
#include "soil/particles/particle_to_grid.h"

#include <string>
#include <vector>

#include "soil/particles/buffers.h"
#include "soil/particles/schedule.h"
#include "soil/particles/soil_table.h"
#include "soil/scheme.h"

namespace navvy::soil {

namespace {

std::vector<std::string> law_options(bool extended_law, const SchemeConstants& scheme) {
  std::vector<std::string> out = scheme_options(scheme);
  if (extended_law) out.push_back(device::define("LAW_EXTENDED", 1));
  return out;
}

}  // namespace

ParticleToGrid::ParticleToGrid(device::Device& device, bool extended_law,
                               const SchemeConstants& scheme)
    : device_(device),
      scheme_(scheme),
      program_(device, kernel_path(device, "particle_to_grid"), law_options(extended_law, scheme)),
      kernel_(program_, "particle_to_grid") {}

// Every scatter rewrites the contents, so only the size matters.
void ParticleToGrid::set_blocks(std::size_t particle_blocks, int tiles) {
  ensure(device_, tiles_, static_cast<std::size_t>(tiles) * 4 * TILE_NODES);
  ensure(device_, used_, particle_blocks);
}

void ParticleToGrid::enqueue(ParticleStore& store, device::Buffer<Report>& report, double dt,
                             double cell, bool hold) {
  kernel_
      .args(store.state(), store.capacity(), store.soils(), store.particle_blocks_buffer(), tiles_,
            used_, report, static_cast<float>(dt), static_cast<float>(cell),
            static_cast<float>(dt / scheme_.mixing_strain),
            static_cast<float>(most_mixing(dt, scheme_)), hold ? 0.0f : 1.0f)
      .enqueue_groups(store.particle_blocks().size());
}

}  // namespace navvy::soil
