// SPDX-License-Identifier: Apache-2.0
// Soil particles listed by the ground columns that they are above.
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "sim/world.h"
#include "soil/particles/particle.h"

namespace navvy::sim {

/// A particle in its column.
struct ListedParticle {
  /// Column of particles beyond the edge of the site.
  static constexpr std::uint32_t kBeyond = std::numeric_limits<std::uint32_t>::max();

  std::uint32_t column;    ///< number of the column, row by row, or kBeyond
  std::uint32_t particle;  ///< index of the particle
  double z;                ///< height in W [m]
};

/// Lists particles in ascending order of their columns, those beyond the edge last. Keeps its
/// memory between calls.
class ColumnList {
 public:
  /// Replaces the list by those of `places`, which are particles of `world`, for which `wanted`
  /// returns true.
  template <class Wanted>
  void take(const World& world, const std::vector<soil::ParticlePlace>& places,
            const Wanted& wanted) {
    list_.clear();
    for (const soil::ParticlePlace& place : places)
      if (wanted(place))
        list_.push_back({0, static_cast<std::uint32_t>(&place - places.data()), 0});
    sort(world, places);
  }
  /// Sorts the list by height within each column. Different particles at one height come in the
  /// order that heightfield::LooseSoil gives to particles in the order of their ids.
  void sort_by_height(const std::vector<soil::ParticlePlace>& places);
  /// Removes the particles beyond the edge.
  void drop_beyond() {
    while (!list_.empty() && list_.back().column == ListedParticle::kBeyond) list_.pop_back();
  }
  /// Returns the list. The caller may change the order within a column.
  std::vector<ListedParticle>& particles() { return list_; }

 private:
  /// Fills in columns and heights, and sorts by columns.
  void sort(const World& world, const std::vector<soil::ParticlePlace>& places);

  std::vector<ListedParticle> list_, spare_;
};

}  // namespace navvy::sim
