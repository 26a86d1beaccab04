// SPDX-License-Identifier: Apache-2.0
// Soil particle as the host sees it, and its frame.
//
// Grid frame G: axes of W, origin near the site's lower-left corner (plan_grid.h) and at the
// ground's datum, lengths in cells. Cell (i, j, k) spans [i, i+1) etc.; node (i, j, k) is its lower
// corner; a block is 4 x 4 x 4 cells. The position of a particle is the integers of its block plus
// an offset from the corner of the block in cells, so that the precision is the same everywhere.
#pragma once

#include <cstdint>

namespace navvy::soil {

/// Edge of a block [cells].
inline constexpr int kBlockCells = 4;

/// Host record of a particle. The device keeps the same fields in its own order. Velocities in m/s,
/// stress in Pa, positive in tension.
struct Particle {
  /// Block that holds it.
  std::int32_t block[3] = {0, 0, 0};
  /// Offset from the block's lower corner at the last transfer [cells], normally 0..4.
  float x[3] = {0, 0, 0};
  /// Velocity [m/s].
  float v[3] = {0, 0, 0};
  /// Velocity gradient, row major: c[3*i+j] = dv_i/dx_j [1/s].
  float c[9] = {0, 0, 0, 0, 0, 0, 0, 0, 0};
  /// Displacement since the last transfer [cells]; Solver::particles adds it to x.
  float moved[3] = {0, 0, 0};
  /// Deviatoric stress xx yy zz xy yz xz.
  float s[6] = {0, 0, 0, 0, 0, 0};
  /// Tracked volume / bank volume of its mass.
  float j = 1;
  /// Density state: the volume ratio without pressure (1 .. swell).
  float j0 = 1;
  /// Accumulated plastic shear [-].
  float shear = 0;
  /// Mass [kMassQuantum].
  std::int32_t mass = 0;
  /// Index of the soil in the world.
  std::uint16_t soil = 0;
  /// 0 none; 1 + 2 tool + (1 behind the shell, 0 in front).
  std::uint16_t side = 0;
  /// Unique for life.
  std::uint32_t id = 0;
};

}  // namespace navvy::soil
