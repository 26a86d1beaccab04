// SPDX-License-Identifier: Apache-2.0
// One soil particle as the host sees it, and the frame it lives in.
//
// Grid frame G: axes of W, origin near the site's lower-left corner (plan_grid.h) and at the
// ground's datum; lengths in cells. Cell (i, j, k) spans [i, i+1) etc.; node (i, j, k) is its lower
// corner; a block is 4 x 4 x 4 cells. A particle's position is its block's integers plus an offset
// from the block's corner in cells, so that its precision is the same everywhere.
#pragma once

#include <cstdint>

namespace navvy::soil {

inline constexpr int kBlockCells = 4;

/// Host record; the device keeps the same fields in its own order. Velocities [m/s], stress [Pa],
/// positive in tension.
struct Particle {
  std::int32_t block[3] = {0, 0, 0};
  /// Offset from the block's lower corner at the last transfer [cells], normally 0..4.
  float x[3] = {0, 0, 0};
  float v[3] = {0, 0, 0};
  /// Velocity gradient, row major: c[3*i+j] = dv_i/dx_j [1/s].
  float c[9] = {0, 0, 0, 0, 0, 0, 0, 0, 0};
  /// Way since the last transfer [cells]; Solver::particles has it in x.
  float moved[3] = {0, 0, 0};
  float s[6] = {0, 0, 0, 0, 0, 0};  ///< deviatoric stress xx yy zz xy yz xz
  float j = 1;                      ///< volume / bank volume of its mass, tracked
  /// Density state: the volume ratio at which it carries no pressure (1 .. swell).
  float j0 = 1;
  float shear = 0;        ///< accumulated plastic shear [-]
  std::int32_t mass = 0;  ///< in kMassQuantum
  std::uint16_t soil = 0;
  std::uint16_t side = 0;  ///< 0 none; 1 + 2 tool + (1 when behind the shell, 0 in front)
  std::uint32_t id = 0;    ///< unique for life
};

}  // namespace navvy::soil
