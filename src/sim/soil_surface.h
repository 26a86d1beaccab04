// SPDX-License-Identifier: Apache-2.0
// The surface of a site as one sees it: resting columns and the loose soil that lies on them.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "sim/world.h"

namespace navvy::sim {

/// Heights of columns plus the particles resting on them; soil in the air or in a bucket does not count.
///
/// Looks at the particles once in every step in which it is asked, so it has no memory that a snapshot would need; one
/// look costs a pass over the particles.
class SoilSurface {
 public:
  explicit SoilSurface(const World& world) : world_(world) {}
  double height(double x, double y) const;

 private:
  void look() const;
  double column_top(int ix, int iy) const;

  const World& world_;
  mutable bool looked_ = false;
  mutable std::uint64_t seen_step_ = 0;
  mutable std::vector<std::pair<std::int64_t, double>> tops_;  ///< column key and W height of its loose soil, by key
};

}  // namespace navvy::sim
