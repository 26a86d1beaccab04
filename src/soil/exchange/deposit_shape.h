// SPDX-License-Identifier: Apache-2.0
// Where the surface of awake soil is: the 0.5 iso-surface of its smoothed volume fraction.
#pragma once

#include <array>
#include <vector>

#include "soil/exchange/exchange_index.h"

namespace navvy::soil {

/// Surface over the 16 columns of a block, x fastest. Heights are in cells above the datum, as
/// everywhere in the exchange, so that rules in cells read without a scale.
struct BlockShape {
  std::array<double, 16> ground;   ///< surface of the columns [cells above datum]
  std::array<double, 16> surface;  ///< iso-surface, at least `ground` [cells above datum]
  /// An empty gap a cell high or more lies below the surface, or soil hangs above it.
  bool hollow = false;
};

/// Samples the volume fraction of columns and particles, smoothed with a quadratic B-spline of the
/// cell, at column centres every half cell. Costs the particles of the block and its neighbourhood.
/// Half a cell is as fine as the particles lie; a finer grid would follow their noise.
class ShapeFinder {
 public:
  /// Both must outlive it. One finder serves many blocks, one after the other: its arrays are
  /// reused.
  ShapeFinder(const heightfield::Ground& ground, const ColumnIndex& index)
      : ground_(ground), index_(index) {}
  /// The shape of one block. The ground must not change between the blocks of one check, or their
  /// order would show.
  BlockShape find(const PlanKey& block);

  // Whether particles over the column have an empty gap below them.
 private:
  bool hangs(int ix, int iy);
  // Adds what each kind of soil contributes to the samples over a column; both add to `fraction_`.
  void sample_columns(int ix, int iy);
  void sample_particles(int ix, int iy);
  // Finds the surface of column c of the block in the samples, and gaps below it.
  void read(BlockShape& shape, std::size_t c) const;

  const heightfield::Ground& ground_;
  const ColumnIndex& index_;
  // Of the block at hand: columns with a margin of one, and the samples of one column from
  // `bottom_` up.
  std::array<double, 36> around_{};
  int x0_ = 0, y0_ = 0;
  double bottom_ = 0;
  std::vector<double> fraction_, heights_;
};

}  // namespace navvy::soil
