// SPDX-License-Identifier: Apache-2.0
// Re-binning: moves particles that have drifted out of their block into the block of their current
// position, on the device and without atomics.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "device/buffer.h"
#include "device/kernel_program.h"
#include "soil/layout.h"
#include "soil/particles/block_table.h"

namespace navvy::soil {

/// Number of destination codes of a particle: codes 0 .. 26 mean neighbour n of the particle's
/// block (neighbour_offset; 13 is the block itself), code 27 means outside the site
/// (kernels/soil/place.h).
inline constexpr std::size_t kRebinCodes = 28;

/// Number of old blocks from which a new block takes particles: its 27 neighbours, and a block of
/// added particles (kernels/soil/place.h).
inline constexpr std::size_t kRebinSources = 28;

/// Particles that come from the host in a re-bin: runs of blocks as in a particle store, but
/// without padding.
struct AddedParticles {
  /// Keys of the blocks, ascending.
  std::vector<BlockKey> keys;
  /// Number of particles in each block.
  std::vector<int> counts;
  /// Cell of each particle's base node within its block, 0 .. 63.
  std::vector<std::uint8_t> cells;
  /// All words of the particles: FIELD_COUNT rows with one word per particle.
  std::vector<float> words;
};

/// Particle blocks after a re-bin, and where their particles come from.
struct RebinPlan {
  /// Keys of the new blocks, ascending.
  std::vector<BlockKey> keys;
  /// Number of particles in each new block.
  std::vector<int> counts;
  /// kRebinSources entries per new block: index of the old block from which particles arrive, or -1
  /// if there is no such block. Those of source i have destination code i, or 26 - i if `ascending`
  /// is true. Blocks of added particles follow the old blocks of the table.
  std::vector<int> sources;
  /// True: within a cell particles are stored in their old order, and added ones after them.
  bool ascending = false;
};

/// Returns the blocks that particles move into. `table`: the old blocks; `counts`: kRebinCodes
/// entries per old block, the number of particles with each destination code. Particles that left
/// the site are in no new block. With `added`, particles keep their order, and those of `added`
/// follow.
RebinPlan plan_rebin(const BlockTable& table, const std::vector<int>& counts,
                     const AddedParticles* added = nullptr);

/// References to one set of stored particles on the device, as arguments of the kernels.
struct StoredParticles {
  /// State array: FIELD_COUNT x capacity words.
  device::Buffer<float>& state;
  /// Number of slots of the state array.
  int capacity;
  /// Slots and count of each particle block.
  device::Buffer<ParticleBlock>& particle_blocks;
};

/// Kernels of kernels/soil/*/rebin.cl, which sort particles into new blocks, remove and add some.
/// Call `count` first, then `add` if there are any to add, then `move`; `move` may be skipped.
///
/// Cost is linear in the number of particles: three passes over their destination codes, and one
/// copy of all fields into the other state array.
class Rebin {
 public:
  /// Builds the kernels.
  explicit Rebin(device::Device& device);

  /// Finds the destination of every particle and returns the number of particles per old block and
  /// destination code, kRebinCodes entries per block; waits for the device.
  ///
  /// `particle_blocks`: number of blocks; `keys`: their keys; `site`: x and y of the site's
  /// lower-left corner, then of its upper-right corner, in G [cells]; `removed`: one flag per slot,
  /// not 0 for particles that have no destination, or empty. Returns an empty list if there are no
  /// blocks.
  std::vector<int> count(const StoredParticles& now, std::size_t particle_blocks,
                         const device::Buffer<std::array<std::int32_t, 4>>& keys,
                         const std::array<std::int32_t, 4>& site,
                         const std::vector<std::uint8_t>& removed = {});
  /// Uploads particles for the next `move`. `now`: the old blocks, to whose list theirs are
  /// appended; `particle_blocks`: number of old blocks.
  /// @throws DeviceError when the device has no memory; nothing has changed then.
  void add(const StoredParticles& now, std::size_t particle_blocks, const AddedParticles& added);
  /// Returns the destination code of every slot from the last `count`; waits for the device.
  /// Entries of slots without a particle are undefined.
  std::vector<std::uint8_t> codes() const { return codes_.read(); }
  /// Allocates memory for a plan with this number of new blocks and slots.
  /// @throws DeviceError when the device has no memory; nothing has changed then.
  void reserve(std::size_t particle_blocks, std::size_t slots);
  /// Queues the copy of the counted and added particles from `now` into their new blocks in `next`,
  /// whose block list must already be that of the plan. Within a block particles are ordered by
  /// cell, within a cell in the order of arrival or as RebinPlan::ascending says. Also writes the
  /// mean contact properties of each new block to `block_surface`.
  void move(const StoredParticles& now, const StoredParticles& next, const RebinPlan& plan,
            const device::Buffer<SoilRow>& soils, device::Buffer<ContactSoil>& block_surface);

 private:
  /// Device that runs the kernels.
  device::Device& device_;
  /// Compiled program of the kernels.
  device::KernelProgram program_;
  /// Kernels in the order of their use: count_kernel_ finds destinations, gather_kernel_ finds the
  /// old slot of each new slot, move_kernel_ copies the fields.
  device::Kernel count_kernel_, gather_kernel_, move_kernel_;
  /// One entry per old slot, from the last `count`: codes_ holds the destination code, cells_ the
  /// cell of the base node within the new block, 0 .. 63.
  device::Buffer<std::uint8_t> codes_, cells_;
  /// kRebinCodes entries per old block: number of particles with each destination code (kernel
  /// rebin_count).
  device::Buffer<std::int32_t> counts_;
  /// RebinPlan::sources on the device.
  device::Buffer<std::int32_t> sources_;
  /// Old slot of the particle in each new slot (kernel rebin_gather).
  device::Buffer<std::int32_t> from_;
  /// One flag per slot: not 0 if the particle is removed.
  device::Buffer<std::uint8_t> removed_;
  /// AddedParticles::words of the next `move`.
  device::Buffer<float> added_;
  /// Number of particles in `added_`.
  int added_count_ = 0;
};

}  // namespace navvy::soil
