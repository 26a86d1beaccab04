// SPDX-License-Identifier: Apache-2.0
// Layout of the particle and grid arrays, shared by host and kernels. The structs hold scalars and
// arrays of scalars only.
//
// Particles are stored by block. The run of each block starts at a multiple of NAVVY_LANES; lanes
// beyond its particles have mass 0. particle_fields.h lists the fields. A particle belongs to the
// block of its base node floor(x - 0.5). So x lies in [0.5, 4.5) after a re-bin and may drift by
// one cell to each side before the next one.
//
// A tile holds the 8 x 8 x 8 nodes -1..6 of a block, x fastest, one float4 each.
#ifndef NAVVY_KERNELS_SOIL_LAYOUT_H
#define NAVVY_KERNELS_SOIL_LAYOUT_H

#include "soil/law_constants.h"
#include "soil/particle_fields.h"
#include "soil/scheme_constants.h"

#define NAVVY_LANES 16

// kMassQuantum of core/math.h [kg]; a lighter node counts as empty.
#define MASS_QUANTUM (1.0f / 16777216.0f)

// 512 nodes and a padded end: a float16 read of the last row stays inside. Not a power of two.
#define TILE_NODES 516
#define BLOCK_NODES 64

#ifdef __cplusplus
#include <cstddef>
namespace navvy::soil {
#endif

// One block that holds particles.
typedef struct ParticleBlock {
  // First slot, a multiple of NAVVY_LANES.
  int start;
  // Number of particles.
  int count;
  // Index of its first tile.
  int tile;
  // 1: near a shell, with three tiles (0 neutral, 1 front, 2 back); 0: one tile.
  int near;
} ParticleBlock;

// Resting ground under the node columns of one active block, x fastest [cells from its corner].
typedef struct BlockFloor {
  // Height up to which nodes are held.
  float held[16];
  // Heights of the four columns around the node column.
  float around[16][4];
} BlockFloor;

// Soil properties that a tool meets. Kernels write it as one float4: all four words are averaged
// alike.
typedef struct ContactSoil {
  // Tangent of the friction angle between soil and tool.
  float friction;
  // Adhesion [Pa].
  float adhesion;
  // 1 / bank density [m3/kg].
  float inv_density;
  float unused;
} ContactSoil;

// Results of one block after a step.
typedef struct Report {
  // 1 when a value was not finite.
  int broken;
  // Fastest velocity component [m/s], infinite for a NaN.
  float speed;
  // Longest push out of a plate [cells].
  float push;
  // Number of particles on the wrong side of a shell.
  int crossed;
} Report;

#ifdef __cplusplus
static_assert(sizeof(ParticleBlock) == 16 && offsetof(ParticleBlock, tile) == 8 &&
              offsetof(ParticleBlock, near) == 12);
static_assert(sizeof(BlockFloor) == 320 && offsetof(BlockFloor, around) == 64);
static_assert(sizeof(ContactSoil) == 16 && offsetof(ContactSoil, inv_density) == 8);
static_assert(sizeof(Report) == 16 && offsetof(Report, push) == 8);
}  // namespace navvy::soil
#endif

#endif  // NAVVY_KERNELS_SOIL_LAYOUT_H
