// SPDX-License-Identifier: Apache-2.0
// Sums of tiles become node velocities after gravity, held by resting ground.
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

/// The kernels of kernels/soil/*/grid_update.cl and what they write.
class GridUpdate {
 public:
  explicit GridUpdate(device::Device& device);

  /// Takes over the active blocks. `near_slot`: index into the near arrays or -1, one entry per
  /// active block.
  void set_blocks(const BlockTable& table, const std::vector<int>& near_slot);
  /// One per active block, see Floor.
  void set_floor(const std::vector<BlockFloor>& floors);
  /// Queues velocities after `dv` [m/s] of gravity: final in far blocks, before contact and floor
  /// in near ones. In a `hold` step nodes add what was scattered to the velocity of the step
  /// before.
  void enqueue(ParticleStore& store, ParticleToGrid& scattered, NearNodes& near, const Vec3& dv,
               bool hold);

  device::Buffer<float>& velocity() { return velocity_; }
  device::Buffer<BlockFloor>& floors() { return floors_; }
  device::Buffer<std::array<std::int32_t, 4>>& active_keys() { return active_keys_; }

 private:
  device::Device& device_;
  device::KernelProgram program_;
  device::Kernel far_kernel_, near_kernel_;
  std::size_t far_ = 0;                    ///< active blocks that are not near
  device::Buffer<std::int32_t> far_list_;  ///< their active indices
  /// 27 home indices per active block, -1: none there.
  device::Buffer<std::int32_t> around_;
  /// Block (x, y, z, 0) of each active block.
  device::Buffer<std::array<std::int32_t, 4>> active_keys_;
  device::Buffer<BlockFloor> floors_;  ///< one per active block
  /// BLOCK_NODES float4s per active block: v [m/s], mass per room [kg]; in near blocks
  /// contact_apply writes them.
  device::Buffer<float> velocity_;
};

}  // namespace navvy::soil
