// SPDX-License-Identifier: Apache-2.0
// Update of the nodes: sums the tiles of the particle blocks and computes node velocities after
// gravity and the hold of resting ground.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/math.h"
#include "device/buffer.h"
#include "device/kernel_program.h"
#include "soil/particles/near_nodes.h"
#include "soil/particles/particle_store.h"
#include "soil/particles/particle_to_grid.h"

namespace navvy::soil {

/// Kernels of kernels/soil/*/grid_update.cl and their results.
///
/// Each active block sums the tiles of the particle blocks around it in a fixed order. An active
/// block is near if a tool's shell may touch its nodes, otherwise far. Nodes of far blocks get
/// their final velocity here. Nodes of near blocks get the velocities of their front and back
/// fields, from which Contact computes the final ones.
class GridUpdate {
 public:
  /// Builds the kernels with the constants `scheme`.
  explicit GridUpdate(device::Device& device, const SchemeConstants& scheme = kScheme);

  /// Uploads the lists of active blocks. `near_slot`: one entry per active block, the block's index
  /// in the near arrays, or -1 for a far block.
  void set_blocks(const BlockTable& table, const std::vector<int>& near_slot);
  /// Uploads the heights of resting ground: Floor::blocks, one entry per active block.
  void set_floor(const std::vector<BlockFloor>& floors);
  /// Queues the computation of node velocities; `dv`: velocity change by gravity in this step
  /// [m/s]. The result is final in far blocks, and before contact and resting ground act in near
  /// blocks. With `hold` (every step of a transfer except the first) nodes keep their velocity and
  /// add the scattered impulse to it.
  void enqueue(ParticleStore& store, ParticleToGrid& scattered, NearNodes& near, const Vec3& dv,
               bool hold);

  /// Returns the node velocities, four floats per node of each active block: velocity [m/s], and
  /// mass divided by the free fraction of the node [kg].
  device::Buffer<float>& velocity() { return velocity_; }
  /// Returns the heights of resting ground, one entry per active block.
  device::Buffer<BlockFloor>& floors() { return floors_; }
  /// Returns the key of each active block as (x, y, z, 0).
  device::Buffer<std::array<std::int32_t, 4>>& active_keys() { return active_keys_; }

 private:
  /// Device that runs the kernels.
  device::Device& device_;
  /// Compiled program of both kernels.
  device::KernelProgram program_;
  /// Kernels: far_kernel_ for far blocks, near_kernel_ for near blocks.
  device::Kernel far_kernel_, near_kernel_;
  /// Number of far active blocks.
  std::size_t far_ = 0;
  /// Active-block indices of the far blocks.
  device::Buffer<std::int32_t> far_list_;
  /// BlockTable::around on the device: 27 particle-block indices per active block, -1 where there
  /// is no particle block.
  device::Buffer<std::int32_t> around_;
  /// Key (x, y, z, 0) of each active block.
  device::Buffer<std::array<std::int32_t, 4>> active_keys_;
  /// Heights of resting ground, one entry per active block.
  device::Buffer<BlockFloor> floors_;
  /// BLOCK_NODES x 4 floats per active block: velocity [m/s], and mass divided by the node's free
  /// fraction [kg]. In near blocks the kernel contact_apply writes them.
  device::Buffer<float> velocity_;
};

}  // namespace navvy::soil
