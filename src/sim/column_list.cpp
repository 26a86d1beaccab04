// SPDX-License-Identifier: Apache-2.0
#include "sim/column_list.h"

#include <algorithm>
#include <array>
#include <utility>

#include "sim/world_parts.h"

namespace navvy::sim {
namespace {

/// Sorts by a number that `key` returns, in passes of 11 bits; particles with equal numbers keep
/// their order. `spare` is memory. A pass in which all digits are equal is left out.
template <class Key>
void sort_by(const Key& key, std::vector<ListedParticle>& list,
             std::vector<ListedParticle>& spare) {
  constexpr int kBits = 11;
  std::array<std::uint32_t, 1 << kBits> count;
  for (int shift = 0; shift < 32; shift += kBits) {
    const auto digit = [&](const ListedParticle& one) {
      return (key(one) >> shift) & ((1u << kBits) - 1);
    };
    count.fill(0);
    for (const ListedParticle& one : list) ++count[digit(one)];
    if (!list.empty() && count[digit(list.front())] == list.size()) continue;
    std::uint32_t sum = 0;
    for (std::uint32_t& each : count) sum += std::exchange(each, sum);
    spare.resize(list.size());
    for (const ListedParticle& one : list) spare[count[digit(one)]++] = one;
    list.swap(spare);
  }
}

/// Returns the greatest integer that is not above `x`, faster than std::floor.
int floor_of(double x) {
  const int toward_zero = static_cast<int>(x);
  return toward_zero - (x < toward_zero ? 1 : 0);
}

}  // namespace

void ColumnList::sort(const World& world, const std::vector<soil::ParticlePlace>& places) {
  const heightfield::Ground& ground = world.ground();
  const soil::PlanGrid& grid = parts(world).soil.grid();
  const double cell = ground.cell(), bottom = parts(world).soil.grid_origin().z();
  for (ListedParticle& one : list_) {
    const Vec3& p = places[one.particle].grid;
    const int ix = grid.x + floor_of(p.x()), iy = grid.y + floor_of(p.y());
    one.column = ground.contains(ix, iy)
                     ? static_cast<std::uint32_t>(iy) * static_cast<std::uint32_t>(ground.nx()) +
                           static_cast<std::uint32_t>(ix)
                     : ListedParticle::kBeyond;
    one.z = bottom + cell * p.z();
  }
  sort_by([](const ListedParticle& one) { return one.column; }, list_, spare_);
}

void ColumnList::sort_by_height(const std::vector<soil::ParticlePlace>& places) {
  for (auto from = list_.begin(), to = from; from != list_.end(); from = to) {
    while (to != list_.end() && to->column == from->column) ++to;
    std::sort(from, to, [](const ListedParticle& a, const ListedParticle& b) { return a.z < b.z; });
  }
  const auto unclear = [&](const ListedParticle& a, const ListedParticle& b) {
    if (a.z != b.z || a.column != b.column) return false;
    const soil::ParticlePlace &p = places[a.particle], &q = places[b.particle];
    return p.mass != q.mass || p.j0 != q.j0 || p.soil != q.soil;
  };
  if (std::adjacent_find(list_.begin(), list_.end(), unclear) == list_.end()) return;
  sort_by([&](const ListedParticle& one) { return places[one.particle].id; }, list_, spare_);
}

}  // namespace navvy::sim
