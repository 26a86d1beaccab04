// SPDX-License-Identifier: Apache-2.0
// The step between particles and grid: scatter from particles to tiles, from tiles to node
// velocities, and gather back to particles.
//
// During a transfer nodes keep their velocities and particles their positions
// [docs/soil.md, transfer]. The kernels are portable: each work-item writes only its own data, and
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

/// The three stages ParticleToGrid, GridUpdate and GridToParticle in their order, and the report
/// that they and the shell kernels write.
///
/// The solver queues `scatter` and `gather` in every step, with the contact solve between them, and
/// `end` after the last step of a transfer. Only read_report waits for the device.
class Transfer {
 public:
  /// Builds the kernels. `extended_law`: see needs_extended_law.
  Transfer(device::Device& device, bool extended_law, const SchemeConstants& scheme = kScheme);

  /// Uploads the block lists; call it after a re-bin and when the near blocks have changed.
  /// `near_slot`: one entry per active block, its index in the near arrays or -1; `tiles`: the
  /// number of tiles that ParticleStore::set_near returned.
  void set_blocks(const ParticleStore& store, const std::vector<int>& near_slot, int tiles);
  /// Uploads the heights of resting ground: Floor::blocks, one entry per active block.
  void set_floor(const std::vector<BlockFloor>& floors) { grid_.set_floor(floors); }

  /// Queues the soil law, the scatter to tiles, and the node velocities after gravity. The
  /// velocities are final in far blocks, and before contact in near blocks. `dt`: step [s]; `cell`:
  /// edge of a cell [m]; `gravity` in W [m/s2]; `hold`: true for every step of a transfer except
  /// the first.
  void scatter(ParticleStore& store, NearNodes& near, double dt, double cell, const Vec3& gravity,
               bool hold);
  /// Queues the gather of node velocities to particles, and records the displacements of the
  /// particles. `dt`: step [s]; `part`: dt / length of a transfer, with which crowded particles are
  /// separated (0: not at all); `cell`: edge of a cell [m].
  void gather(ParticleStore& store, NearNodes& near, double dt, double part, double cell);
  /// Queues the end of the transfer: particles move by their recorded displacement.
  void end(ParticleStore& store) { grid_to_particle_.enqueue_end(store); }
  /// Summary of the block reports of one step.
  struct Largest {
    /// Largest velocity component of any particle [m/s]; infinite if a value was not finite.
    double speed = 0;
    /// Longest displacement by which a particle was pushed out of a plate [cells].
    double push = 0;
    /// Number of particles on the wrong side of a shell.
    std::uint64_t crossed = 0;
  };
  /// Reads the reports of all blocks and returns their maxima and sums; waits for everything queued
  /// before. `particle_blocks`: number of blocks.
  Largest read_report(std::size_t particle_blocks) const;

  /// Returns the node velocities of the front field: BLOCK_NODES x 4 floats per active block
  /// (GridUpdate::velocity).
  device::Buffer<float>& velocity() { return grid_.velocity(); }
  /// Returns the reports on the device, one per particle block.
  device::Buffer<Report>& report() { return report_; }
  /// Returns the heights of resting ground on the device, one entry per active block.
  device::Buffer<BlockFloor>& floors() { return grid_.floors(); }
  /// Returns the key (x, y, z, 0) of each active block, on the device.
  device::Buffer<std::array<std::int32_t, 4>>& active_keys() { return grid_.active_keys(); }

 private:
  /// Device that runs the kernels.
  device::Device& device_;
  /// First stage: soil law and scatter to tiles.
  ParticleToGrid particle_to_grid_;
  /// Second stage: node velocities from tiles.
  GridUpdate grid_;
  /// Third stage: gather to particles.
  GridToParticle grid_to_particle_;
  /// Report of each particle block.
  device::Buffer<Report> report_;
};

}  // namespace navvy::soil
