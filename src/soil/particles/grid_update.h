// SPDX-License-Identifier: Apache-2.0
// Update of nodes: sums of tiles become velocities after gravity, held by resting ground.
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
/// Each active block adds the tiles of the particle blocks around it in a fixed order. Far blocks
/// get their final velocity here; near blocks get two fields, which Contact completes.
class GridUpdate {
 public:
  /// Builds the kernels with these constants.
  explicit GridUpdate(device::Device& device, const SchemeConstants& scheme = kScheme);

  /// Uploads the active blocks. `near_slot`: index into the near arrays or -1, one entry per active
  /// block.
  void set_blocks(const BlockTable& table, const std::vector<int>& near_slot);
  /// Uploads one entry per active block, see Floor.
  void set_floor(const std::vector<BlockFloor>& floors);
  /// Queues velocities after `dv` [m/s] of gravity: final in far blocks, before contact and floor
  /// in near ones. In a `hold` step nodes add the scattered impulse to their velocity.
  void enqueue(ParticleStore& store, ParticleToGrid& scattered, NearNodes& near, const Vec3& dv,
               bool hold);

  device::Buffer<float>& velocity() { return velocity_; }
  device::Buffer<BlockFloor>& floors() { return floors_; }
  device::Buffer<std::array<std::int32_t, 4>>& active_keys() { return active_keys_; }

 private:
  device::Device& device_;
  device::KernelProgram program_;
  device::Kernel far_kernel_, near_kernel_;
  /// Number of active blocks that are not near.
  std::size_t far_ = 0;
  /// Their active-block indices.
  device::Buffer<std::int32_t> far_list_;
  /// 27 particle-block indices per active block, -1: none there.
  device::Buffer<std::int32_t> around_;
  /// Block (x, y, z, 0) of each active block.
  device::Buffer<std::array<std::int32_t, 4>> active_keys_;
  /// One per active block.
  device::Buffer<BlockFloor> floors_;
  /// BLOCK_NODES float4s per active block: v [m/s], mass per free volume [kg]. In near blocks
  /// contact_apply writes them.
  device::Buffer<float> velocity_;
};

}  // namespace navvy::soil
