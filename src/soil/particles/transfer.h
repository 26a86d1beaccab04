// SPDX-License-Identifier: Apache-2.0
// The step between particles and grid: scatter to tiles, tiles to node velocities, gather; over the
// steps of a transfer nodes keep their velocities and particles their places
// [docs/soil.md, transfer]. A portable, unfused schedule: each work-item writes only what it owns,
// every sum has a fixed order.
#pragma once

#include <vector>

#include "core/math.h"
#include "device/buffer.h"
#include "soil/particles/grid_to_particle.h"
#include "soil/particles/grid_update.h"
#include "soil/particles/near_nodes.h"
#include "soil/particles/particle_store.h"
#include "soil/particles/particle_to_grid.h"

namespace navvy::soil {

/// The three stages in their order, with the report that they and the shell kernels write.
class Transfer {
 public:
  /// `extended_law`: see needs_extended_law.
  Transfer(device::Device& device, bool extended_law);

  /// Takes over the block lists after a re-bin or a change of the near blocks. `near_slot` has one
  /// entry per active block; `tiles` is what ParticleStore::set_near returned.
  void set_blocks(const ParticleStore& store, const std::vector<int>& near_slot, int tiles);
  void set_floor(const std::vector<BlockFloor>& floors) { grid_.set_floor(floors); }

  /// Law and scatter, then node velocities after gravity: final in far blocks, before contact in
  /// near ones. `hold`: not the first step of a transfer.
  void scatter(ParticleStore& store, NearNodes& near, double dt, double cell, const Vec3& gravity,
               bool hold);
  /// Queues gather of a step that is the share `part` of a transfer, 0: nothing is moved apart; the
  /// way of the particles is booked.
  void gather(ParticleStore& store, NearNodes& near, double dt, double part, double cell);
  /// Queues the transfer's end: particles go the way that was booked.
  void end(ParticleStore& store) { grid_to_particle_.enqueue_end(store); }
  /// Largest values over the home blocks after a step; waits.
  struct Largest {
    double speed = 0;  ///< velocity component [m/s]; infinite when a value was not finite
    double push = 0;   ///< out of a plate [cells]
    std::uint64_t crossed = 0;
  };
  Largest read_report(std::size_t particle_blocks) const;

  device::Buffer<float>& velocity() { return grid_.velocity(); }
  device::Buffer<Report>& report() { return report_; }
  device::Buffer<BlockFloor>& floors() { return grid_.floors(); }
  device::Buffer<std::array<std::int32_t, 4>>& active_keys() { return grid_.active_keys(); }

 private:
  device::Device& device_;
  ParticleToGrid particle_to_grid_;
  GridUpdate grid_;
  GridToParticle grid_to_particle_;
  device::Buffer<Report> report_;  ///< one per home
};

}  // namespace navvy::soil
