// SPDX-License-Identifier: Apache-2.0
// Layout of the particle and grid arrays, read by the host and by the kernels. Scalars and arrays
// of scalars only.
//
// Particles are stored by home block, each block's run starting at a multiple of NAVVY_LANES; lanes
// past a block's count have mass 0. Their fields: particle_fields.h. A particle's home is the block
// of its base node floor(x - 0.5), so x runs over [0.5, 4.5) after a re-bin and may drift one cell
// to each side before the next one. A tile is the 8 x 8 x 8 nodes -1..6 of a home block, x fastest,
// one float4 each.
#ifndef NAVVY_KERNELS_SOIL_LAYOUT_H
#define NAVVY_KERNELS_SOIL_LAYOUT_H

#include "soil/law_constants.h"
#include "soil/particle_fields.h"

#define NAVVY_LANES 16

#define MASS_QUANTUM (1.0f / 16777216.0f)  // core/math.h kMassQuantum [kg]; a lighter node is empty

#define TILE_NODES 516  // 512 and a pad row end: a float16 read of the last row stays inside; not a power of two
#define BLOCK_NODES 64

// Densest state that soil is pressed into, and that columns take from particles (a tighter clamp
// creates volume).
#define DENSEST_STATE 0.88

#ifdef __cplusplus
#include <cstddef>
namespace navvy::soil {
#endif

// One home block: a block that holds particles.
typedef struct ParticleBlock {
  int start;  // first slot, a multiple of NAVVY_LANES
  int count;  // particles
  int tile;   // first tile
  int near;   // 1: near a shell, three tiles (0 neutral, 1 front, 2 back); 0: one
} ParticleBlock;

// Resting ground of one active block [cells from its corner], per node column, x fastest.
typedef struct BlockFloor {
  float held[16];       // height up to which nodes are held
  float around[16][4];  // heights of the four columns around the node column
} BlockFloor;

// What a tool finds on soil. Written as float4s: all four words are averaged alike.
typedef struct ContactSoil {
  float friction;     // tan of the friction angle between soil and tool
  float adhesion;     // [Pa]
  float inv_density;  // 1 / bank density [m3/kg]
  float unused;
} ContactSoil;

// Report of one home block after a step.
typedef struct Report {
  int broken;   // 1 when a value was not finite
  float speed;  // fastest velocity component [m/s], infinite for a NaN
  float push;   // farthest push out of a plate [cells]
  int crossed;  // particles on the wrong side of a shell
} Report;

#ifdef __cplusplus
static_assert(sizeof(ParticleBlock) == 16 && offsetof(ParticleBlock, tile) == 8 && offsetof(ParticleBlock, near) == 12);
static_assert(sizeof(BlockFloor) == 320 && offsetof(BlockFloor, around) == 64);
static_assert(sizeof(ContactSoil) == 16 && offsetof(ContactSoil, inv_density) == 8);
static_assert(sizeof(Report) == 16 && offsetof(Report, push) == 8);
}  // namespace navvy::soil
#endif

#endif  // NAVVY_KERNELS_SOIL_LAYOUT_H
