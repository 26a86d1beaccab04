// SPDX-License-Identifier: Apache-2.0
// Surface of active soil: the 0.5 iso-surface of its smoothed volume fraction.
#pragma once

#include <array>
#include <vector>

#include "soil/exchange/exchange_index.h"

namespace navvy::soil {

/// Surface over the 16 columns of a block, x fastest. Heights are in cells above the datum, as
/// everywhere in the exchange.
struct BlockShape {
  /// Surface of the columns [cells above datum].
  std::array<double, 16> ground;
  /// Iso-surface, at least `ground` [cells above datum].
  std::array<double, 16> surface;
  /// A gap of a cell or more lies below the surface, or soil hangs above it.
  bool hollow = false;
};

/// Samples the volume fraction of columns and particles, smoothed with a quadratic B-spline of the
/// cell, at column centres every half cell. Half a cell is the spacing of particles; a finer grid
/// would follow their noise. Cost is linear in the particles of the block and its neighbourhood.
///
/// Columns count as full below their surface and particles as their volume in the density state, so
/// that the seam between both does not show.
class ShapeFinder {
 public:
  /// Reads ground and index, which must outlive it. One finder serves many blocks, one after the
  /// other, and reuses its arrays.
  ShapeFinder(const heightfield::Ground& ground, const ColumnIndex& index)
      : ground_(ground), index_(index) {}
  /// Returns the shape of one block. The ground must not change between the blocks of one check, or
  /// their order would matter.
  BlockShape find(const PlanKey& block);

  // Returns true if particles over the column have a gap below them.
 private:
  bool hangs(int ix, int iy);
  // Add the contribution of each kind of soil to the samples over a column, in `fraction_`.
  void sample_columns(int ix, int iy);
  void sample_particles(int ix, int iy);
  // Finds the surface of column c of the block in the samples, and gaps below it.
  void read(BlockShape& shape, std::size_t c) const;

  const heightfield::Ground& ground_;
  const ColumnIndex& index_;
  // Current block: its columns with a margin of one, and the samples of one column from `bottom_`
  // up.
  std::array<double, 36> around_{};
  int x0_ = 0, y0_ = 0;
  double bottom_ = 0;
  std::vector<double> fraction_, heights_;
};

}  // namespace navvy::soil
