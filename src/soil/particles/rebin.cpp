// SPDX-License-Identifier: Apache-2.0
#include "soil/particles/rebin.h"

#include <algorithm>

#include "soil/particles/buffers.h"
#include "soil/particles/schedule.h"

namespace navvy::soil {

// New blocks follow from flows, not from particles: the host reads 28 numbers per block.
RebinPlan plan_rebin(const BlockTable& table, const std::vector<int>& counts) {
  RebinPlan plan;
  for (std::size_t h = 0; h < table.particle_blocks.size(); ++h)
    for (std::size_t n = 0; n < 27; ++n)
      if (counts[kRebinCodes * h + n] > 0)
        plan.keys.push_back(table.particle_blocks[h] + neighbour_offset(static_cast<int>(n)));
  std::sort(plan.keys.begin(), plan.keys.end());
  plan.keys.erase(std::unique(plan.keys.begin(), plan.keys.end()), plan.keys.end());

  // For each new block, the old blocks around it that send particles, in the fixed order of the
  // codes. The order of arrival does not depend on the device.
  plan.sources.assign(27 * plan.keys.size(), -1);
  plan.counts.assign(plan.keys.size(), 0);
  for (std::size_t k = 0; k < plan.keys.size(); ++k)
    for (std::size_t n = 0; n < 27; ++n) {
      // A flow along n comes from the block on the opposite side.
      const BlockKey d = neighbour_offset(static_cast<int>(n)), key = plan.keys[k];
      const int old = table.particle_block_index.find({key.x - d.x, key.y - d.y, key.z - d.z});
      const int flow = old < 0 ? 0 : counts[kRebinCodes * static_cast<std::size_t>(old) + n];
      if (flow == 0) continue;
      plan.sources[27 * k + n] = old;
      plan.counts[k] += flow;
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
                              const std::array<std::int32_t, 4>& site) {
  std::vector<int> counts(kRebinCodes * particle_blocks);
  if (particle_blocks == 0) return counts;
  // Per slot and not per particle: the kernels index by slot.
  fit(device_, codes_, static_cast<std::size_t>(now.capacity));
  fit(device_, cells_, static_cast<std::size_t>(now.capacity));
  fit(device_, counts_, counts.size());
  count_kernel_
      .args(now.state, now.capacity, now.particle_blocks, keys, codes_, cells_, counts_, site)
      .enqueue_groups(particle_blocks);
  counts_.read(counts);
  return counts;
}

void Rebin::reserve(std::size_t particle_blocks, std::size_t slots) {
  fit(device_, sources_, 27 * particle_blocks);
  fit(device_, from_, slots);
}

void Rebin::move(const StoredParticles& now, const StoredParticles& next, const RebinPlan& plan,
                 const device::Buffer<SoilRow>& soils, device::Buffer<ContactSoil>& block_surface) {
  sources_.write(plan.sources);
  gather_kernel_
      .args(now.particle_blocks, codes_, cells_, counts_, next.particle_blocks, sources_, from_)
      .enqueue_groups(plan.keys.size());
  move_kernel_
      .args(now.state, now.capacity, codes_, from_, next.particle_blocks, next.state, next.capacity,
            soils, block_surface)
      .enqueue_groups(plan.keys.size());
}

}  // namespace navvy::soil
