// SPDX-License-Identifier: Apache-2.0
// Soil particle as the host stores it, and the grid frame G.
//
// The axes of G are those of W. The origin of G is near the lower-left corner of the site
// (plan_grid.h), at the height of the ground's datum; lengths are in cells. Cell (i, j, k) spans
// [i, i + 1) along x, and so on; node (i, j, k) is the lower corner of that cell; a block is 4 x 4
// x 4 cells. A particle's position consists of the integer coordinates of its block and an offset
// from the block's lower corner in cells, so that the precision is the same everywhere on the site.
#pragma once

#include <cstdint>

#include "core/math.h"

namespace navvy::soil {

/// Number of cells along an edge of a block.
inline constexpr int kBlockCells = 4;

/// Host copy of a particle. The device stores the same fields in a different order
/// (particle_fields.h). Stresses are in Pa and positive in tension.
struct Particle {
  /// Coordinates (x, y, z) of the block that the particle is stored in.
  std::int32_t block[3] = {0, 0, 0};
  /// Offset from the block's lower corner at the last transfer [cells], normally 0 .. 4.
  float x[3] = {0, 0, 0};
  /// Velocity [m/s].
  float v[3] = {0, 0, 0};
  /// Velocity gradient, row by row: c[3 * i + j] = dv_i/dx_j [1/s].
  float c[9] = {0, 0, 0, 0, 0, 0, 0, 0, 0};
  /// Displacement since the last transfer [cells]. Solver::particles adds it to `x`.
  float moved[3] = {0, 0, 0};
  /// Deviatoric stress, in the order xx, yy, zz, xy, yz, xz [Pa].
  float s[6] = {0, 0, 0, 0, 0, 0};
  /// Volume ratio J: tracked volume / bank volume of the same mass.
  float j = 1;
  /// Density state J0: the volume ratio at which the soil carries no pressure (1 in bank state, up
  /// to swell when loose).
  float j0 = 1;
  /// Plastic shear strain accumulated since bank state.
  float shear = 0;
  /// Mass [kMassQuantum].
  std::int32_t mass = 0;
  /// Index of the particle's soil in the world's list of soils.
  std::uint16_t soil = 0;
  /// Side of a tool's shell: 0 if no shell is near, else 1 + 2 * tool index, plus 1 if the particle
  /// is behind the shell.
  std::uint16_t side = 0;
  /// ID, unique among all particles of a run.
  std::uint32_t id = 0;
};

/// The part of a particle that shows where soil is and how much.
struct ParticlePlace {
  /// Current position in G [cells].
  Vec3 grid = Vec3::Zero();
  /// Mass [kMassQuantum].
  std::int32_t mass = 0;
  /// Density state J0 (Particle::j0).
  float j0 = 1;
  /// ID, unique among all particles of a run.
  std::uint32_t id = 0;
  /// Index of the particle's soil in the world's list of soils.
  std::uint16_t soil = 0;
};

}  // namespace navvy::soil
