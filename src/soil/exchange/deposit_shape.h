// SPDX-License-Identifier: Apache-2.0
// Surface of active soil: the iso-surface at 0.5 of its smoothed volume fraction.
#pragma once

#include <array>
#include <vector>

#include "soil/exchange/exchange_index.h"

namespace navvy::soil {

/// Surface over the 16 columns of a block; arrays are ordered with x fastest.
struct BlockShape {
  /// Height of each column [cells above datum].
  std::array<double, 16> ground;
  /// Height of the iso-surface over each column, at least `ground` [cells above datum].
  std::array<double, 16> surface;
  /// True if there is a gap of a cell or more below the surface, or soil that hangs above one.
  bool hollow = false;
};

/// Finds the surface of active soil over a block. It samples the volume fraction of columns and
/// particles at the column centres, at every half cell of height, smoothed with a quadratic
/// B-spline that reaches 1.5 cells to each side. Particles are about half a cell apart; a finer
/// grid would follow their noise.
///
/// Columns count as full below their surface, and particles with their volume in the density state,
/// so that no seam appears between the two. Cost is linear in the number of particles in the block
/// and around it.
class ShapeFinder {
 public:
  /// Reads `ground` and `index`, which must outlive this object. One finder can process many blocks
  /// one after another; it reuses its arrays.
  ShapeFinder(const heightfield::Ground& ground, const ColumnIndex& index)
      : ground_(ground), index_(index) {}
  /// Returns the shape of one block. During one check, the ground must not change between calls, or
  /// the result would depend on the order of the blocks.
  BlockShape find(const PlanKey& block);

 private:
  /// Returns true if there is a gap below the particles over column (ix, iy).
  bool hangs(int ix, int iy);
  /// Adds the volume fraction of the columns around column (ix, iy) to the samples in `fraction_`.
  void sample_columns(int ix, int iy);
  /// Adds the volume fraction of the particles around column (ix, iy) to the samples in
  /// `fraction_`.
  void sample_particles(int ix, int iy);
  /// Finds the surface of column c (0 .. 15) in the samples and stores it in `shape`; sets `hollow`
  /// if there is a gap below it.
  void read(BlockShape& shape, std::size_t c) const;

  /// Columns of the site.
  const heightfield::Ground& ground_;
  /// Active particles of the soil, sorted by the column that they are over.
  const ColumnIndex& index_;
  /// Heights of the current block's columns with a margin of one column, 6 x 6, x fastest
  /// [cells above datum].
  std::array<double, 36> around_{};
  /// Lower-left column of the current block.
  int x0_ = 0, y0_ = 0;
  /// Height of the lowest sample [cells above datum].
  double bottom_ = 0;
  /// `fraction_`: samples of the volume fraction over one column, from `bottom_` upwards.
  /// `heights_`: scratch memory for particle heights.
  std::vector<double> fraction_, heights_;
};

}  // namespace navvy::soil
