// SPDX-License-Identifier: Apache-2.0
#include "soil/particles/transfer.h"

#include <algorithm>
#include <limits>

#include "soil/particles/buffers.h"

namespace navvy::soil {

Transfer::Transfer(device::Device& device, bool extended_law, const SchemeConstants& scheme)
    : device_(device),
      particle_to_grid_(device, extended_law, scheme),
      grid_(device, scheme),
      grid_to_particle_(device, scheme) {}

void Transfer::set_blocks(const ParticleStore& store, const std::vector<int>& near_slot,
                          int tiles) {
  const BlockTable& table = store.table();
  particle_to_grid_.set_blocks(table.particle_blocks.size(), tiles);
  grid_.set_blocks(table, near_slot);
  grid_to_particle_.set_blocks(table);
  ensure(device_, report_, table.particle_blocks.size());
}

void Transfer::scatter(ParticleStore& store, NearNodes& near, double dt, double cell,
                       const Vec3& gravity, bool hold) {
  // The queue is in order: the grid update sees finished tiles.
  particle_to_grid_.enqueue(store, report_, dt, cell, hold);
  grid_.enqueue(store, particle_to_grid_, near, gravity * dt, hold);
}

void Transfer::gather(ParticleStore& store, NearNodes& near, double dt, double part, double cell) {
  grid_to_particle_.enqueue(store, grid_.velocity(), near, particle_to_grid_.used(), report_, dt,
                            part, cell);
}

Transfer::Largest Transfer::read_report(std::size_t particle_blocks) const {
  // One small read per step; it waits for everything queued before.
  Largest out;
  for (const Report& particle_block : report_.map_read(0, particle_blocks)) {
    out.speed = std::max(out.speed, static_cast<double>(particle_block.speed));
    if (particle_block.broken != 0) out.speed = std::numeric_limits<double>::infinity();
    out.push = std::max(out.push, static_cast<double>(particle_block.push));
    out.crossed += static_cast<std::uint64_t>(particle_block.crossed);
  }
  return out;
}

}  // namespace navvy::soil
