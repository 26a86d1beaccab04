// SPDX-License-Identifier: Apache-2.0
// Layout of the particle and grid arrays, shared by host and kernels. The structs contain only
// scalars and arrays of scalars.
//
// Particles are stored block by block. The slots of each block start at a multiple of NAVVY_LANES;
// unused slots at the end have mass 0. particle_fields.h lists the fields. A particle belongs to
// the block of its base node floor(x - 0.5), where x is relative to the corner of the block in
// cells. After a re-bin x is therefore in [0.5, 4.5), and it may drift by one cell to each side
// before the next re-bin.
//
// A tile contains the 8 x 8 x 8 nodes -1 .. 6 around a block, x fastest, four floats each.
#ifndef NAVVY_KERNELS_SOIL_LAYOUT_H
#define NAVVY_KERNELS_SOIL_LAYOUT_H

#include "soil/law_constants.h"
#include "soil/particle_fields.h"
#include "soil/scheme_constants.h"

// Number of particles that one work-item of the lanes schedule computes at a time.
#define NAVVY_LANES 16

// Unit of integer masses [kg], kMassQuantum of core/math.h. A node lighter than this counts as
// empty.
#define MASS_QUANTUM (1.0f / 16777216.0f)

// Number of nodes for which a tile has memory: 512, and padding so that a float16 read of the last
// row stays inside. It is deliberately not a power of two.
#define TILE_NODES 516
// Number of nodes of a block.
#define BLOCK_NODES 64

#ifdef __cplusplus
#include <cstddef>
namespace navvy::soil {
#endif

// Slots and tiles of one block that contains particles.
typedef struct ParticleBlock {
  // First slot, a multiple of NAVVY_LANES.
  int start;
  // Number of particles.
  int count;
  // Index of the block's first tile.
  int tile;
  // 1 if the block is near a shell and has three tiles (0 neutral, 1 front, 2 back); 0 if it has
  // one tile.
  int near;
} ParticleBlock;

// Heights of resting ground at the 4 x 4 node columns of one active block, x fastest, relative to
// the block's lower corner [cells].
typedef struct BlockFloor {
  // Height up to which the nodes of each node column are held by the ground.
  float held[16];
  // Heights of the four ground columns that meet at each node column: (-, -), (+, -), (-, +), (+,
  // +) in (x, y).
  float around[16][4];
} BlockFloor;

// Properties of soil in contact with a tool. Kernels write it as one float4, because all four words
// are averaged in the same way.
typedef struct ContactSoil {
  // Friction coefficient between soil and tool.
  float friction;
  // Adhesion of the soil to tools [Pa].
  float adhesion;
  // 1 / bank density [m3/kg].
  float inv_density;
  // Padding to 16 bytes.
  float unused;
} ContactSoil;

// Summary of one particle block after a step.
typedef struct Report {
  // 1 if a value of a particle was not finite, else 0.
  int broken;
  // Largest velocity component of any particle [m/s]; infinite for a NaN.
  float speed;
  // Longest displacement by which a particle was pushed out of a plate [cells].
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
