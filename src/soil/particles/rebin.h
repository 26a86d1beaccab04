// SPDX-License-Identifier: Apache-2.0
// Re-binning: sorts particles that drifted into their new blocks on the device, without atomics.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "device/buffer.h"
#include "device/kernel_program.h"
#include "soil/layout.h"
#include "soil/particles/block_table.h"

namespace navvy::soil {

/// Number of destinations of a block's particles: codes 0..26 into that neighbour, 27 off the site
/// (kernels/soil/place.h).
inline constexpr std::size_t kRebinCodes = 28;

/// New blocks that follow from a count.
struct RebinPlan {
  /// Sorted.
  std::vector<BlockKey> keys;
  /// Particles per new block.
  std::vector<int> counts;
  /// 27 per new block: old block from which code n leads here, -1: none.
  std::vector<int> sources;
};

/// Returns the new blocks: those that any particle goes to. `counts`: kRebinCodes per block of the
/// table. Particles that left the site are in none.
RebinPlan plan_rebin(const BlockTable& table, const std::vector<int>& counts);

/// One state of the particles on the device, as the kernels take it.
struct StoredParticles {
  /// FIELD_COUNT x capacity words.
  device::Buffer<float>& state;
  /// Number of slots.
  int capacity;
  device::Buffer<ParticleBlock>& particle_blocks;
};

/// Kernels of kernels/soil/*/rebin.cl. Calls come in the order count, move; `move` may be left out.
///
/// Cost is linear in the particles: three passes over their codes and one copy of all fields into
/// the other state array.
class Rebin {
 public:
  /// Builds the kernels.
  explicit Rebin(device::Device& device);

  /// Counts where particles go, kRebinCodes per block; waits. `site`: x and y of its lower left and
  /// its upper right corner in G [cells]. Without blocks there are no counts.
  std::vector<int> count(const StoredParticles& now, std::size_t particle_blocks,
                         const device::Buffer<std::array<std::int32_t, 4>>& keys,
                         const std::array<std::int32_t, 4>& site);
  /// Returns the code of every slot from the last count; waits. Slots without a particle have none.
  std::vector<std::uint8_t> codes() const { return codes_.read(); }
  /// Reserves memory for a plan of this many blocks and slots. Throws before anything has changed
  /// when there is none.
  void reserve(std::size_t particle_blocks, std::size_t slots);
  /// Queues the move of the counted particles into their new blocks (`next.particle_blocks`), by
  /// cell and in the order of arrival, and the blocks' mean surfaces.
  void move(const StoredParticles& now, const StoredParticles& next, const RebinPlan& plan,
            const device::Buffer<SoilRow>& soils, device::Buffer<ContactSoil>& block_surface);

 private:
  device::Device& device_;
  device::KernelProgram program_;
  device::Kernel count_kernel_, gather_kernel_, move_kernel_;
  // From the last count and move.
  /// Per old slot (rebin_count).
  device::Buffer<std::uint8_t> codes_, cells_;
  /// kRebinCodes per old block (rebin_count).
  device::Buffer<std::int32_t> counts_;
  /// 27 per new block (host).
  device::Buffer<std::int32_t> sources_;
  /// Old slot of each new slot (rebin_gather).
  device::Buffer<std::int32_t> from_;
};

}  // namespace navvy::soil
