// SPDX-License-Identifier: Apache-2.0
#include "soil/exchange/exchange_index.h"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>
#include <vector>

namespace navvy::soil {
namespace {

/// Distance of centres beyond which soil does not rest on the soil below: one empty cell and half a
/// particle above and below it [docs/exchange.md, deposit].
constexpr double kMostGap = 1.5;
// Half of a particle's spacing [cells].
constexpr double kHalfParticle = 0.25;
constexpr std::size_t kColumnsPerBlock = kBlockCells * kBlockCells;

// Both numbers may be negative; as 32 bits each they still distinguish blocks. The order of the
// packed key has no meaning.
std::uint64_t packed(const PlanKey& key) {
  return static_cast<std::uint64_t>(static_cast<std::uint32_t>(key.first)) << 32 |
         static_cast<std::uint32_t>(key.second);
}

}  // namespace

ColumnIndex::ColumnIndex(std::span<const Particle> particles, const heightfield::Ground& ground,
                         PlanGrid grid, std::span<const std::uint8_t> without)
    : particles_(particles), ground_(ground), grid_(grid) {
  group(without);
  sort_columns();
  build_piles();
}

void ColumnIndex::group(std::span<const std::uint8_t> without) {
  // Blocks in order of first occurrence, then renumbered in ascending order, so that the input's
  // order has no effect.
  std::vector<std::uint32_t> slots;
  slots.reserve(particles_.size());
  std::vector<PlanKey> seen;
  std::uint32_t last = 0;
  for (std::size_t i = 0; i < particles_.size(); ++i) {
    if (!without.empty() && without[i] != 0) continue;
    const auto [ix, iy] = grid_.column_of(particles_[i]);
    const PlanKey key = grid_.block_of(ix, iy);
    // A particle is mostly in the block of the one before it, which needs no look-up.
    if (seen.empty() || seen[last] != key) {
      const auto [found, is_new] = place_.emplace(packed(key), static_cast<int>(seen.size()));
      if (is_new) seen.push_back(key);
      last = static_cast<std::uint32_t>(found->second);
    }
    slots.push_back(last * static_cast<std::uint32_t>(kColumnsPerBlock) +
                    static_cast<std::uint32_t>(grid_.place(ix, iy)));
  }
  keys_ = seen;
  std::sort(keys_.begin(), keys_.end());
  std::vector<std::size_t> rank(seen.size());
  for (std::size_t b = 0; b < keys_.size(); ++b) {
    int& place = place_[packed(keys_[b])];
    rank[static_cast<std::size_t>(place)] = b;
    place = static_cast<int>(b);
  }
  // Counting sort by column.
  begin_.assign(keys_.size() * kColumnsPerBlock + 1, 0);
  for (std::uint32_t& h : slots) {
    h = static_cast<std::uint32_t>(rank[h / kColumnsPerBlock] * kColumnsPerBlock +
                                   h % kColumnsPerBlock);
    ++begin_[h + 1];
  }
  for (std::size_t c = 1; c < begin_.size(); ++c) begin_[c] += begin_[c - 1];
  // Particles of one column are contiguous now, in the order of the input until sort_columns.
  order_.resize(slots.size());
  std::vector<std::uint32_t> next(begin_.begin(), begin_.end());
  auto slot = slots.begin();
  for (std::size_t i = 0; i < particles_.size(); ++i)
    if (without.empty() || without[i] == 0) order_[next[*slot++]++] = static_cast<std::uint32_t>(i);
}

void ColumnIndex::sort_columns() {
  // Particles at one height are ordered by their properties, never by their place in the input. Ids
  // distinguish a solver's particles; the rest only matters to callers that give none.
  const auto rank = [&](std::uint32_t i) {
    const Particle& p = particles_[i];
    return std::tuple(p.id, p.x[0], p.x[1], p.mass, p.soil, p.j0, p.shear);
  };
  // Heights of one column, so that most comparisons stay in the cache.
  std::vector<std::pair<double, std::uint32_t>> heights;
  for (std::size_t c = 0; c + 1 < begin_.size(); ++c) {
    heights.clear();
    for (std::uint32_t o = begin_[c]; o < begin_[c + 1]; ++o)
      heights.emplace_back(height_in_cells(particles_[order_[o]]), order_[o]);
    std::sort(heights.begin(), heights.end(), [&](const auto& a, const auto& b) {
      return a.first != b.first ? a.first < b.first : rank(a.second) < rank(b.second);
    });
    for (std::size_t i = 0; i < heights.size(); ++i) order_[begin_[c] + i] = heights[i].second;
  }
}

void ColumnIndex::build_piles() {
  const double cell = ground_.cell();
  const auto& soils = ground_.setup().soils;
  piles_.resize(keys_.size() * kColumnsPerBlock);
  for (std::size_t c = 0; c < piles_.size(); ++c) {
    const PlanKey block = keys_[c / kColumnsPerBlock];
    const int place = static_cast<int>(c % kColumnsPerBlock);
    const int ix = grid_.column_x(block, place), iy = grid_.column_y(block, place);
    Pile& pile = piles_[c];
    const double surface = (ground_.height(ix, iy) - ground_.datum()) / cell;
    pile.top = surface;
    // From the lowest up to the first gap: particles in the air above it are not part of the pile.
    for (std::uint32_t o = begin_[c]; o < begin_[c + 1]; ++o) {
      const Particle& p = particles_[order_[o]];
      const double z = height_in_cells(p);
      if (z - pile.top > kMostGap) break;
      pile.top = std::max(pile.top, z);
      pile.mass += p.mass;
      pile.height += kilograms(p.mass) * p.j0 / (soils[p.soil].bank_density * cell * cell * cell);
    }
    // Particles may be looser than their state; the surface is then at the top of the highest one.
    if (pile.mass > 0) pile.height = std::max(pile.height, pile.top + kHalfParticle - surface);
  }
}

int ColumnIndex::find(const PlanKey& block) const {
  const auto found = place_.find(packed(block));
  return found == place_.end() ? -1 : found->second;
}

int ColumnIndex::slot(int ix, int iy) const {
  const int b = find(grid_.block_of(ix, iy));
  return b < 0 ? -1 : b * static_cast<int>(kColumnsPerBlock) + grid_.place(ix, iy);
}

std::span<const std::uint32_t> ColumnIndex::column(int ix, int iy) const {
  const int c = slot(ix, iy);
  if (c < 0) return {};
  const auto at = static_cast<std::size_t>(c);
  return std::span(order_).subspan(begin_[at], begin_[at + 1] - begin_[at]);
}

std::span<const std::uint32_t> ColumnIndex::block(int b) const {
  const std::size_t first = static_cast<std::size_t>(b) * kColumnsPerBlock;
  return std::span(order_).subspan(begin_[first], begin_[first + kColumnsPerBlock] - begin_[first]);
}

Pile ColumnIndex::pile(int ix, int iy) const {
  const int c = slot(ix, iy);
  if (c >= 0) return piles_[static_cast<std::size_t>(c)];
  Pile none;
  none.top = (ground_.height(ix, iy) - ground_.datum()) / ground_.cell();
  return none;
}

double ColumnIndex::pile_height(int ix, int iy) const {
  const int c = slot(ix, iy);
  return c < 0 ? 0.0 : piles_[static_cast<std::size_t>(c)].height;
}

}  // namespace navvy::soil
