// SPDX-License-Identifier: Apache-2.0
// Where the surface of awake soil is: the 0.5 iso-surface of its smoothed volume fraction.
#pragma once

#include <array>
#include <vector>

#include "soil/exchange/exchange_index.h"

namespace navvy::soil {

/// Surface over the 16 columns of a block, x fastest.
struct BlockShape {
  std::array<double, 16> ground;   ///< surface of the columns [cells above datum]
  std::array<double, 16> surface;  ///< iso-surface, at least `ground` [cells above datum]
  bool hollow = false;             ///< an empty gap a cell high or more lies below the surface, or soil hangs above it
};

/// Samples the volume fraction of columns and particles, smoothed with a quadratic B-spline of the cell, at column
/// centres every half cell. Costs the particles of the block and its neighbourhood.
class ShapeFinder {
 public:
  ShapeFinder(const heightfield::Ground& ground, const ColumnIndex& index) : ground_(ground), index_(index) {}
  BlockShape find(const PlanKey& block);

 private:
  bool hangs(int ix, int iy);
  void sample_columns(int ix, int iy);
  void sample_particles(int ix, int iy);
  void read(BlockShape& shape, std::size_t c) const;

  const heightfield::Ground& ground_;
  const ColumnIndex& index_;
  // Of the block at hand: columns with a margin of one, and the samples of one column from `bottom_` up.
  std::array<double, 36> around_{};
  int x0_ = 0, y0_ = 0;
  double bottom_ = 0;
  std::vector<double> fraction_, heights_;
};

}  // namespace navvy::soil
