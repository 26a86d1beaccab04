// SPDX-License-Identifier: Apache-2.0
// Re-binning: particles that drifted find their new home blocks, sorted on the device without
// atomics.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "device/buffer.h"
#include "device/kernel_program.h"
#include "soil/layout.h"
#include "soil/particles/block_table.h"

namespace navvy::soil {

/// Where a home's particles go: codes 0..26 into that neighbour, 27 off the site
/// (kernels/soil/place.h).
inline constexpr std::size_t kRebinCodes = 28;

/// The new homes that follow from a count.
struct RebinPlan {
  std::vector<BlockKey> keys;  ///< sorted
  std::vector<int> counts;     ///< particles per new home
  std::vector<int> sources;    ///< 27 per new home: old home from which code n leads here, -1: none
};

/// `counts`: kRebinCodes per home of the table. New homes are wherever a flow leads; what left the
/// site is in none.
RebinPlan plan_rebin(const BlockTable& table, const std::vector<int>& counts);

/// One state of the particles on the device, as the kernels take it.
struct StoredParticles {
  device::Buffer<float>& state;  ///< FIELD_COUNT x capacity words
  int capacity;
  device::Buffer<ParticleBlock>& particle_blocks;
};

/// The kernels of kernels/soil/*/rebin.cl. Calls come in the order count, move; `move` may be left
/// out.
class Rebin {
 public:
  explicit Rebin(device::Device& device);

  /// Counts where particles go, kRebinCodes per home; waits. `site`: x and y of its lower left and
  /// its upper right corner in G [cells]. No homes: no counts.
  std::vector<int> count(const StoredParticles& now, std::size_t particle_blocks,
                         const device::Buffer<std::array<std::int32_t, 4>>& keys,
                         const std::array<std::int32_t, 4>& site);
  /// Code of every slot as of the last count; waits. Slots that hold no particle have none.
  std::vector<std::uint8_t> codes() const { return codes_.read(); }
  /// Makes room for a plan of this many homes and slots; throws before anything changed when there
  /// is none.
  void reserve(std::size_t particle_blocks, std::size_t slots);
  /// Queues moving the counted particles into their new homes (laid out in `next.homes`), by cell
  /// and in the order of arrival, and the homes' mean surfaces.
  void move(const StoredParticles& now, const StoredParticles& next, const RebinPlan& plan,
            const device::Buffer<SoilRow>& soils, device::Buffer<ContactSoil>& block_surface);

 private:
  device::Device& device_;
  device::KernelProgram program_;
  device::Kernel count_kernel_, gather_kernel_, move_kernel_;
  // Of the last count and move.
  device::Buffer<std::uint8_t> codes_, cells_;  ///< per old slot (rebin_count)
  device::Buffer<std::int32_t> counts_;         ///< kRebinCodes per old home (rebin_count)
  device::Buffer<std::int32_t> sources_;        ///< 27 per new home (the host)
  device::Buffer<std::int32_t> from_;           ///< per new slot: its old slot (rebin_gather)
};

}  // namespace navvy::soil
