// SPDX-License-Identifier: Apache-2.0
#include "soil/particles/mass_count.h"

#include <utility>

#include "soil/particles/buffers.h"
#include "soil/particles/schedule.h"

namespace navvy::soil {

MassCount::MassCount(device::Device& device, std::size_t soils)
    : device_(device),
      soils_(soils),
      program_(device, kernel_path(device, "mass_count")),
      kernel_(program_, "mass_count") {}

void MassCount::reserve(std::size_t particle_blocks) {
  // Unmap before the kernel writes again, and before the buffer is replaced.
  sums_.reset();
  ensure(device_, masses_, particle_blocks * soils_);
}

void MassCount::queue(ParticleStore& store) {
  reserve(store.particle_blocks().size());
  kernel_
      .args(store.state(), store.capacity(), store.particle_blocks_buffer(), masses_,
            static_cast<int>(soils_))
      .enqueue_groups(store.particle_blocks().size());
  sums_.emplace(masses_.map_read_later(0, store.particle_blocks().size() * soils_));
}

std::vector<std::int64_t> MassCount::take() {
  std::vector<std::int64_t> out(soils_, 0);
  if (!sums_) return out;
  const device::Mapped<const std::int64_t> sums = std::move(*sums_);
  sums_.reset();
  for (std::size_t i = 0; i < sums.size(); ++i) out[i % soils_] += sums[i];
  return out;
}

}  // namespace navvy::soil
