// SPDX-License-Identifier: Apache-2.0
#include "soil/particles/rebin.h"

#include <algorithm>
#include <utility>

#include "soil/particles/buffers.h"
#include "soil/particles/schedule.h"

namespace navvy::soil {

// New blocks follow from flows, not from particles: the host reads 28 numbers per block.
RebinPlan plan_rebin(const BlockTable& table, const std::vector<int>& counts,
                     const AddedParticles* added) {
  RebinPlan plan;
  plan.ascending = added != nullptr;
  if (added != nullptr) plan.keys = added->keys;
  for (std::size_t h = 0; h < table.particle_blocks.size(); ++h)
    for (std::size_t n = 0; n < 27; ++n)
      if (counts[kRebinCodes * h + n] > 0)
        plan.keys.push_back(table.particle_blocks[h] + neighbour_offset(static_cast<int>(n)));
  std::sort(plan.keys.begin(), plan.keys.end());
  plan.keys.erase(std::unique(plan.keys.begin(), plan.keys.end()), plan.keys.end());

  // For each new block, the old blocks around it that send particles, in a fixed order. The order
  // of arrival does not depend on the device.
  plan.sources.assign(kRebinSources * plan.keys.size(), -1);
  plan.counts.assign(plan.keys.size(), 0);
  for (std::size_t k = 0; k < plan.keys.size(); ++k)
    for (std::size_t n = 0; n < 27; ++n) {
      // A flow along n comes from the block on the opposite side.
      const BlockKey d = neighbour_offset(static_cast<int>(n)), key = plan.keys[k];
      const int old = table.particle_block_index.find({key.x - d.x, key.y - d.y, key.z - d.z});
      const int flow = old < 0 ? 0 : counts[kRebinCodes * static_cast<std::size_t>(old) + n];
      if (flow == 0) continue;
      plan.sources[kRebinSources * k + (plan.ascending ? 26 - n : n)] = old;
      plan.counts[k] += flow;
    }
  for (std::size_t a = 0; added != nullptr && a < added->keys.size(); ++a) {
    const auto found = std::lower_bound(plan.keys.begin(), plan.keys.end(), added->keys[a]);
    const auto k = static_cast<std::size_t>(found - plan.keys.begin());
    plan.sources[kRebinSources * k + 27] = static_cast<int>(table.particle_blocks.size() + a);
    plan.counts[k] += added->counts[a];
  }
  return plan;
}

Rebin::Rebin(device::Device& device)
    : device_(device),
      program_(device, kernel_path(device, "rebin")),
      count_kernel_(program_, "rebin_count"),
      gather_kernel_(program_, "rebin_gather"),
      move_kernel_(program_, "rebin_move") {}

std::vector<int> Rebin::count(const StoredParticles& now, std::size_t particle_blocks,
                              const device::Buffer<std::array<std::int32_t, 4>>& keys,
                              const std::array<std::int32_t, 4>& site,
                              const std::vector<std::uint8_t>& removed) {
  std::vector<int> counts(kRebinCodes * particle_blocks);
  if (particle_blocks == 0) return counts;
  // Per slot and not per particle: the kernels index by slot.
  fit(device_, codes_, static_cast<std::size_t>(now.capacity));
  fit(device_, cells_, static_cast<std::size_t>(now.capacity));
  fit(device_, counts_, counts.size());
  ensure(device_, removed_, removed.size());
  removed_.write(removed);
  count_kernel_
      .args(now.state, now.capacity, now.particle_blocks, keys, codes_, cells_, counts_, site,
            removed_, removed.empty() ? 0 : 1)
      .enqueue_groups(particle_blocks);
  counts_.read(counts);
  return counts;
}

void Rebin::add(const StoredParticles& now, std::size_t particle_blocks,
                const AddedParticles& added) {
  const std::size_t count = added.cells.size(), capacity = static_cast<std::size_t>(now.capacity);
  if (count == 0) return;
  fit(device_, now.particle_blocks, particle_blocks + added.keys.size());
  fit(device_, codes_, capacity + count);
  fit(device_, cells_, capacity + count);
  fit(device_, counts_, kRebinCodes * (particle_blocks + added.keys.size()));
  ensure(device_, added_, added.words.size());
  // Their slots are those after the old ones, and their blocks are those that they stay in.
  constexpr std::uint8_t kStay = 13;
  std::vector<ParticleBlock> blocks;
  std::vector<std::int32_t> counts(kRebinCodes * added.keys.size(), 0);
  int start = now.capacity;
  for (std::size_t a = 0; a < added.keys.size(); ++a) {
    blocks.push_back({start, added.counts[a], 0, 0});
    counts[kRebinCodes * a + kStay] = added.counts[a];
    start += added.counts[a];
  }
  now.particle_blocks.write(blocks, particle_blocks);
  codes_.fill(kStay, capacity, count);
  cells_.write(added.cells, capacity);
  counts_.write(counts, kRebinCodes * particle_blocks);
  added_.write(added.words);
  added_count_ = static_cast<int>(count);
}

void Rebin::reserve(std::size_t particle_blocks, std::size_t slots) {
  fit(device_, sources_, kRebinSources * particle_blocks);
  fit(device_, from_, slots);
  // An argument of every move.
  fit(device_, added_, 1);
}

void Rebin::move(const StoredParticles& now, const StoredParticles& next, const RebinPlan& plan,
                 const device::Buffer<SoilRow>& soils, device::Buffer<ContactSoil>& block_surface) {
  sources_.write(plan.sources);
  gather_kernel_
      .args(now.particle_blocks, codes_, cells_, counts_, next.particle_blocks, sources_, from_,
            plan.ascending ? 1 : 0)
      .enqueue_groups(plan.keys.size());
  move_kernel_
      .args(now.state, now.capacity, codes_, from_, next.particle_blocks, next.state, next.capacity,
            soils, block_surface, added_, std::exchange(added_count_, 0))
      .enqueue_groups(plan.keys.size());
}

}  // namespace navvy::soil
