// SPDX-License-Identifier: Apache-2.0
// Processing of a block's particles in chunks that fit local memory: sorts the particles of a chunk
// by cell, and sums what the particles of one cell give to the nodes.
#ifndef NAVVY_KERNELS_SOIL_GROUPS_CHUNK_H
#define NAVVY_KERNELS_SOIL_GROUPS_CHUNK_H

#include "soil/groups/group.h"
#include "soil/point.h"

// Number of particles in a chunk: a multiple of NAVVY_LANES and at most CELLS.
#define CHUNK 208

// Words that are staged in local memory for each particle; word f of particle i is at f * CHUNK +
// i. Words 0 .. 2 (STAGED_P): momentum at the base node. Words 3 .. 11 (STAGED_A): change of that
// momentum per node along x, y and z. STAGED_MASS: mass [kg]. Words 13 .. 15 (STAGED_F): offset
// from the base node [cells]. STAGED is the number of words.
#define STAGED_P 0
#define STAGED_A 3
#define STAGED_MASS 12
#define STAGED_F 13
#define STAGED 16

// Returns the index (x fastest, 0 .. CELLS - 1) of the cell of a particle's base node, from the
// particle's position relative to the corner of its block [cells].
static inline int cell_of(float x, float y, float z) {
  return (int)base_node(x) + 1 + 6 * ((int)base_node(y) + 1) + 36 * ((int)base_node(z) + 1);
}

// Returns the position of this work-item's particle when the `count` particles of the chunk are
// sorted by cell and, within a cell, by stored order.
//
// cells: cell of each particle; cell: that of this work-item's particle. first, counts: output, for
// each cell the position of its first particle and the number of its particles; counts must be zero
// before the call.
static inline int place_in_chunk(local const int* cells, int count, int cell, local int* first,
                                 local int* counts) {
  const int me = get_local_id(0);
  int lower = 0, earlier = 0;
  // Every work-item counts on its own. This costs count^2 reads of local memory, but the order does
  // not depend on the schedule, as that of atomics would.
  for (int i = 0; i < count; ++i) {
    lower += cells[i] < cell;
    earlier += cells[i] == cell && i < me;
  }
  if (earlier == 0) first[cell] = lower;
  atomic_inc(&counts[cell]);
  return lower + earlier;
}

// Returns the index in the tile (8 x 8 x 8 nodes) of the base node of a cell (6 x 6 x 6).
static inline int tile_node(int cell) { return cell % 6 + 8 * (cell / 6 % 6) + 64 * (cell / 36); }

// Sums the momentum [kg m/s] and mass [kg] that the particles of one cell give to the nine nodes of
// one layer; sums: output, x fastest, one float4 (momentum, mass) per node.
//
// stage: staged words of the chunk; sides: tile of each particle; first, count: range of the cell's
// particles; t: tile whose particles are summed, others are skipped; layer: 0, 1 or 2 nodes above
// the base node.
static inline void add_layer(local const float* stage, local const int* sides, int first, int count,
                             int t, int layer, float4* sums) {
  UNROLL
  for (int o = 0; o < 9; ++o) sums[o] = (float4)(0.0f);
  for (int i = first; i < first + count; ++i) {
    if (sides[i] != t) continue;
    local const float* staged = stage + i;
    float wx[3], wy[3], wz[3];
    spline(staged[(STAGED_F + 0) * CHUNK], wx);
    spline(staged[(STAGED_F + 1) * CHUNK], wy);
    spline(staged[(STAGED_F + 2) * CHUNK], wz);
    const float4 start =
        (float4)(staged[0], staged[CHUNK], staged[2 * CHUNK], staged[STAGED_MASS * CHUNK]);
    const float4 ax = (float4)(staged[3 * CHUNK], staged[4 * CHUNK], staged[5 * CHUNK], 0.0f);
    const float4 ay = (float4)(staged[6 * CHUNK], staged[7 * CHUNK], staged[8 * CHUNK], 0.0f);
    const float4 az = (float4)(staged[9 * CHUNK], staged[10 * CHUNK], staged[11 * CHUNK], 0.0f);
    const float w = layer == 0 ? wz[0] : layer == 1 ? wz[1] : wz[2];
    // Momentum at a node is start + i ax + j ay + k az, built up by additions along the rows.
    float4 row = start + (float)layer * az;
    UNROLL
    for (int j = 0; j < 3; ++j) {
      const float4 next = row + ax;
      sums[3 * j] = fma((float4)(w * wy[j] * wx[0]), row, sums[3 * j]);
      sums[3 * j + 1] = fma((float4)(w * wy[j] * wx[1]), next, sums[3 * j + 1]);
      sums[3 * j + 2] = fma((float4)(w * wy[j] * wx[2]), next + ax, sums[3 * j + 2]);
      row += ay;
    }
  }
}

#endif  // NAVVY_KERNELS_SOIL_GROUPS_CHUNK_H
