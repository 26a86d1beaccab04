// SPDX-License-Identifier: Apache-2.0
#include "soil/particles/grid_to_particle.h"

#include <algorithm>

#include "soil/particles/buffers.h"
#include "soil/particles/schedule.h"
#include "soil/particles/soil_table.h"
#include "soil/scheme.h"

namespace navvy::soil {

GridToParticle::GridToParticle(device::Device& device, const SchemeConstants& scheme)
    : device_(device),
      scheme_(scheme),
      program_(device, kernel_path(device, "grid_to_particle"), scheme_options(scheme)),
      kernel_(program_, "grid_to_particle"),
      end_kernel_(program_, "grid_to_particle_end") {}

void GridToParticle::set_blocks(const BlockTable& table) {
  upload(device_, neighbours_, table.neighbours);
}

void GridToParticle::enqueue(ParticleStore& store, device::Buffer<float>& velocity, NearNodes& near,
                             device::Buffer<std::int32_t>& used, device::Buffer<Report>& report,
                             double dt, double part, double cell) {
  // The largest separation is that of a transfer; its steps share it.
  kernel_
      .args(store.state(), store.capacity(), store.particle_blocks_buffer(), neighbours_, velocity,
            near.velocity1, near.slot, near.split, used, report, static_cast<float>(dt),
            static_cast<float>(cell),
            static_cast<float>(packed_mass(store.densest(), cell, scheme_)),
            static_cast<float>(filled_mass(store.densest(), cell, scheme_)),
            static_cast<float>(scheme_.closing_share * std::min(1.0, part)),
            static_cast<float>(dt / scheme_.crowding_strain),
            static_cast<float>(scheme_.max_crowding_displacement * std::min(1.0, part)))
      .enqueue_groups(store.particle_blocks().size());
}

void GridToParticle::enqueue_end(ParticleStore& store) {
  end_kernel_.args(store.state(), store.capacity(), store.particle_blocks_buffer())
      .enqueue_groups(store.particle_blocks().size());
}

}  // namespace navvy::soil
