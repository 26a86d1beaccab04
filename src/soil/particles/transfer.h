// SPDX-License-Identifier: Apache-2.0
// The step between particles and grid: scatter to tiles, tiles to node velocities, gather. During a
// transfer nodes keep their velocities and particles their positions [docs/soil.md, transfer]. The
// schedule is portable and unfused: each work-item writes only its own data, and every sum has a
// fixed order.
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
///
/// `scatter` and `gather` are queued in every step, with the contact solve between them; `end`
/// follows the last step of a transfer. Only read_report waits.
class Transfer {
 public:
  /// Builds the kernels. `extended_law`: see needs_extended_law.
  Transfer(device::Device& device, bool extended_law, const SchemeConstants& scheme = kScheme);

  /// Uploads the lists of blocks after a re-bin or a change of the near blocks. `near_slot` has one
  /// entry per active block; `tiles` comes from ParticleStore::set_near.
  void set_blocks(const ParticleStore& store, const std::vector<int>& near_slot, int tiles);
  /// Uploads the heights of resting ground, one entry per active block.
  void set_floor(const std::vector<BlockFloor>& floors) { grid_.set_floor(floors); }

  /// Queues law and scatter, then node velocities after gravity: final in far blocks, before
  /// contact in near ones. `hold`: not the first step of a transfer.
  void scatter(ParticleStore& store, NearNodes& near, double dt, double cell, const Vec3& gravity,
               bool hold);
  /// Queues the gather of a step that is the share `part` of a transfer, and records displacements.
  /// With `part` = 0 crowded particles are not separated.
  void gather(ParticleStore& store, NearNodes& near, double dt, double part, double cell);
  /// Queues the end of the transfer: particles move by their recorded displacement.
  void end(ParticleStore& store) { grid_to_particle_.enqueue_end(store); }
  /// Largest values over all blocks after a step.
  struct Largest {
    /// Velocity component [m/s]; infinite when a value was not finite.
    double speed = 0;
    /// Push out of a plate [cells].
    double push = 0;
    std::uint64_t crossed = 0;
  };
  /// Reads the report of all blocks; waits for everything queued before.
  Largest read_report(std::size_t particle_blocks) const;

  /// Returns the node velocities of field 0, BLOCK_NODES float4s per active block.
  device::Buffer<float>& velocity() { return grid_.velocity(); }
  /// Returns the reports, one per particle block.
  device::Buffer<Report>& report() { return report_; }
  /// Returns the heights of resting ground, one per active block.
  device::Buffer<BlockFloor>& floors() { return grid_.floors(); }
  /// Returns the block (x, y, z, 0) of each active block.
  device::Buffer<std::array<std::int32_t, 4>>& active_keys() { return grid_.active_keys(); }

 private:
  device::Device& device_;
  ParticleToGrid particle_to_grid_;
  GridUpdate grid_;
  GridToParticle grid_to_particle_;
  /// One per block.
  device::Buffer<Report> report_;
};

}  // namespace navvy::soil
