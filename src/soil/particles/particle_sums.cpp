// SPDX-License-Identifier: Apache-2.0
// Places and masses of stored particles, read in place.
#include <algorithm>
#include <bit>
#include <cmath>

#include "soil/particles/particle_store.h"

namespace navvy::soil {

std::vector<PointMass> ParticleStore::masses_near(const Vec3& low, const Vec3& high) const {
  // A block holds what re-bins found from half a cell above its key on; in between, particles drift
  // by less than a cell.
  constexpr double kFrom = -1, kTo = kBlockCells + 2;
  std::vector<PointMass> out;
  if (count_ == 0) return out;
  const auto capacity = static_cast<std::size_t>(capacity_[now_]);
  // The last map waits for all.
  const auto x = state_[now_].map_read_later(FIELD_X * capacity, 3 * capacity),
             moved = state_[now_].map_read_later(FIELD_MOVED * capacity, 3 * capacity),
             mass = state_[now_].map_read(FIELD_MASS * capacity, capacity);
  for (std::size_t h = 0; h < particle_blocks_.size(); ++h) {
    const Vec3 corner = kBlockCells * Vec3(table_.particle_blocks[h].x, table_.particle_blocks[h].y,
                                           table_.particle_blocks[h].z);
    if (((corner.array() + kFrom) > high.array()).any() ||
        ((corner.array() + kTo) < low.array()).any())
      continue;
    for (int i = 0; i < particle_blocks_[h].count; ++i) {
      const auto slot = static_cast<std::size_t>(particle_blocks_[h].start + i);
      PointMass point;
      for (std::size_t a = 0; a < 3; ++a)
        point.grid[static_cast<int>(a)] = corner[static_cast<int>(a)] +
                                          static_cast<double>(x[a * capacity + slot]) +
                                          static_cast<double>(moved[a * capacity + slot]);
      // Positions include the displacement of the current transfer.
      if ((point.grid.array() < low.array()).any() || (point.grid.array() > high.array()).any())
        continue;
      point.mass = std::bit_cast<std::int32_t>(mass[slot]);
      out.push_back(point);
    }
  }
  return out;
}

void ParticleStore::places(std::vector<ParticlePlace>& out) const {
  out.resize(static_cast<std::size_t>(count_));
  if (count_ == 0) return;
  const auto view = state_[now_].map_read();
  const auto capacity = static_cast<std::size_t>(capacity_[now_]);
  std::size_t to = 0;
  for (std::size_t h = 0; h < particle_blocks_.size(); ++h) {
    const int corner[3] = {kBlockCells * table_.particle_blocks[h].x,
                           kBlockCells * table_.particle_blocks[h].y,
                           kBlockCells * table_.particle_blocks[h].z};
    for (int i = 0; i < particle_blocks_[h].count; ++i) {
      const float* words = view.data() + particle_blocks_[h].start + i;
      ParticlePlace& place = out[to++];
      for (std::size_t a = 0; a < 3; ++a) {
        // Rounded as in Solver::particles: to floats in the block that contains the place.
        float x = words[(FIELD_X + a) * capacity] + words[(FIELD_MOVED + a) * capacity];
        // Most places are in the block itself, and a call of floor takes as long as all else here.
        const float block =
            x >= 0 && x < kBlockCells ? 0.0f : kBlockCells * std::floor(x / kBlockCells);
        x -= block;
        place.grid[static_cast<int>(a)] =
            corner[a] + static_cast<double>(block) + static_cast<double>(x);
      }
      place.mass = std::bit_cast<std::int32_t>(words[FIELD_MASS * capacity]);
      place.j0 = words[FIELD_J0 * capacity];
      place.id = std::bit_cast<std::uint32_t>(words[FIELD_ID * capacity]);
      place.soil = static_cast<std::uint16_t>(
          std::bit_cast<std::uint32_t>(words[FIELD_TAG * capacity]) & 0xffff);
    }
  }
}

double ParticleStore::densest() const {
  double out = 0;
  for (const SoilRow& soil : soil_rows_)
    out = std::max(out, 1 / static_cast<double>(soil.inv_density));
  return out;
}

std::vector<std::int64_t> ParticleStore::masses(std::size_t soils) const {
  // Integer sums are exact, so their order does not matter.
  std::vector<std::int64_t> out(soils, 0);
  if (count_ == 0) return out;
  const auto view = state_[now_].map_read();
  const auto capacity = static_cast<std::size_t>(capacity_[now_]);
  // Particles that are no longer finite have no mass: a run that failed shows an open ledger.
  std::vector<float> sums;
  for (const ParticleBlock& particle_block : particle_blocks_) {
    const auto n = static_cast<std::size_t>(particle_block.count);
    const float* first = view.data() + particle_block.start;
    // Finite numbers have a finite sum here: none is near the end of the range unless the run has
    // failed.
    sums.assign(n, 0.0f);
    for (std::size_t f = 0; f < FIELD_MASS; ++f)
      for (std::size_t i = 0; i < n; ++i) sums[i] += first[f * capacity + i];
    for (std::size_t i = 0; i < n; ++i) {
      if (!std::isfinite(sums[i])) continue;
      const auto tag = std::bit_cast<std::uint32_t>(first[FIELD_TAG * capacity + i]);
      out.at(tag & 0xffff) += std::bit_cast<std::int32_t>(first[FIELD_MASS * capacity + i]);
    }
  }
  return out;
}

}  // namespace navvy::soil
