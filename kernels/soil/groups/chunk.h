// SPDX-License-Identifier: Apache-2.0
// Processing of a block's particles in chunks that fit local memory: sorts the particles of a chunk
// by cell, and sums what the particles of the cells give to the nodes.
#ifndef NAVVY_KERNELS_SOIL_GROUPS_CHUNK_H
#define NAVVY_KERNELS_SOIL_GROUPS_CHUNK_H

#include "soil/groups/group.h"
#include "soil/point.h"

// Number of particles in a chunk, and of work-items in a group.
#define CHUNK 256
// Words of 32 marks, one for each particle of a chunk.
#define MARK_WORDS (CHUNK / 32)
// Cells are summed in slabs of two layers, which are twelve rows of six cells along x. A row gives
// to 8 x 3 x 3 nodes.
#define SLAB_LAYERS 2
#define SLAB_ROWS (6 * SLAB_LAYERS)
#define SLAB_CELLS (6 * SLAB_ROWS)
#define SLABS (CELLS / SLAB_CELLS)
#define ROW_NODES 72
// Work-items that sum a row together.
#define TEAM 32
#define TEAMS_PER_LAYER (CHUNK / TEAM / SLAB_LAYERS)

// Local memory: 31344 bytes here and 872 in particle_to_grid.cl, of 32768.
#if CHUNK <= CELLS || CHUNK % 32 != 0 || TILE_SIZE % CHUNK != 0 || TEAM < 27
#error "a cell needs a work-item of its own, a row 27, and each work-item as many nodes of the tile"
#endif

// A chunk in local memory.
typedef struct Chunk {
  // What each particle gives to the nodes, sorted by cell: at i, momentum at the base node
  // [kg m/s] and mass [kg]; at CHUNK * (1 + axis) + i, change of that momentum per node along the
  // axis, and offset from the base node along it [cells].
  float4 staged[4 * CHUNK];
  // `sort` is dead when `sums` is written: a barrier separates them.
  union {
    struct {
      // For each cell, one bit per particle of the chunk.
      uint marks[CELLS * MARK_WORDS];
      // Number of particles of each cell, of each row of six cells, and of each layer.
      int counts[CELLS], row_counts[CELLS / 6], layer_counts[CELLS / 36];
    } sort;
    // Momentum and mass that each row of a slab gives to its nodes: 3 along y, 3 along z, then 8
    // along x.
    float4 sums[SLAB_ROWS * ROW_NODES];
  } phase;
  // Position of the first particle of each cell among those sorted by cell.
  int first[CELLS + 1];
  // Tile of each particle, sorted by cell.
  uchar tiles[CHUNK];
} Chunk;

// Returns the index (x fastest, 0 .. CELLS - 1) of the cell of a particle's base node, from the
// particle's position relative to the corner of its block [cells].
static inline int cell_of(float x, float y, float z) {
  return (int)base_node(x) + 1 + 6 * ((int)base_node(y) + 1) + 36 * ((int)base_node(z) + 1);
}

// Marks this work-item's particle, if it has one, in its cell. Bits do not depend on the order in
// which they are set. All work-items must call it; it ends with a barrier.
static inline void mark(local Chunk* chunk, bool has_particle, int cell) {
  const int me = get_local_id(0);
  for (int i = me; i < CELLS * MARK_WORDS; i += CHUNK) chunk->phase.sort.marks[i] = 0;
  barrier(CLK_LOCAL_MEM_FENCE);
  if (has_particle)
    atomic_or(&chunk->phase.sort.marks[MARK_WORDS * cell + me / 32], 1u << (me % 32));
  barrier(CLK_LOCAL_MEM_FENCE);
}

static inline int sum_of_six(local const int* counts) {
  return counts[0] + counts[1] + counts[2] + counts[3] + counts[4] + counts[5];
}

// Returns the position of this work-item's particle when those of the chunk are sorted by cell and,
// within a cell, by stored order. @pre `mark`. Sets `first`. All work-items must call it; a barrier
// must follow before `sums` is written.
static inline int place_in_chunk(local Chunk* chunk, int cell) {
  const int me = get_local_id(0);
  if (me < CELLS) {
    int count = 0;
    UNROLL
    for (int w = 0; w < MARK_WORDS; ++w)
      count += popcount(chunk->phase.sort.marks[MARK_WORDS * me + w]);
    chunk->phase.sort.counts[me] = count;
  }
  barrier(CLK_LOCAL_MEM_FENCE);
  if (me < CELLS / 6)
    chunk->phase.sort.row_counts[me] = sum_of_six(chunk->phase.sort.counts + 6 * me);
  barrier(CLK_LOCAL_MEM_FENCE);
  if (me < CELLS / 36)
    chunk->phase.sort.layer_counts[me] = sum_of_six(chunk->phase.sort.row_counts + 6 * me);
  barrier(CLK_LOCAL_MEM_FENCE);
  if (me <= CELLS) {
    int before = 0;
    for (int layer = 0; layer < me / 36; ++layer) before += chunk->phase.sort.layer_counts[layer];
    for (int row = me / 36 * 6; row < me / 6; ++row) before += chunk->phase.sort.row_counts[row];
    for (int i = me / 6 * 6; i < me; ++i) before += chunk->phase.sort.counts[i];
    chunk->first[me] = before;
  }
  barrier(CLK_LOCAL_MEM_FENCE);
  local const uint* marks = chunk->phase.sort.marks + MARK_WORDS * cell;
  int place = chunk->first[cell] + popcount(marks[me / 32] & ((1u << (me % 32)) - 1));
  for (int w = 0; w < me / 32; ++w) place += popcount(marks[w]);
  return place;
}

// One of the three weights of spline() in soil/point.h as a parabola: top + curve (f - middle)^2.
typedef struct Weight {
  float middle, curve, top;
} Weight;

// Returns the weight of the node `i` nodes after the base node along an axis.
static inline Weight weight_of(int i) {
  const Weight out = {1.5f - 0.5f * (float)i, i == 1 ? -1.0f : 0.5f, i == 1 ? 0.75f : 0.0f};
  return out;
}

static inline float weigh(Weight weight, float f) {
  const float d = f - weight.middle;
  return fma(weight.curve * d, d, weight.top);
}

// Sums what the particles of tile t in each row of a slab give to the row's nodes; `several` is
// false if all particles are of that tile. Along the row a work-item takes every third node, so
// that it has one node at a time and no other work-item adds to that.
static inline void sum_rows(local Chunk* chunk, int slab, int t, bool several) {
  const int team = get_local_id(0) / TEAM, item = get_local_id(0) % TEAM;
  if (item >= 27) return;
  const int third = item % 3, beside = item / 3;
  const float j = (float)(beside % 3), k = (float)(beside / 3);
  const Weight of_y = weight_of(beside % 3), of_z = weight_of(beside / 3);
  // After a re-bin the middle 4 x 4 cells of a layer have particles; this gives each team one row
  // of them.
  const int layer = team / TEAMS_PER_LAYER;
  for (int y = team % TEAMS_PER_LAYER; y < 6; y += TEAMS_PER_LAYER) {
    local const int* first = chunk->first + SLAB_CELLS * slab + 36 * layer + 6 * y;
    local float4* sums = chunk->phase.sums + ROW_NODES * (6 * layer + y) + beside;
    float4 sum = 0.0f;
    for (int x = 0; x < 6; ++x) {
      const int i = (third + 6 - x) % 3, end = first[x + 1];
      const Weight of_x = weight_of(i);
      UNROLL_BY_FOUR
      for (int p = first[x]; p < end; ++p) {
        const float4 start = chunk->staged[p], ax = chunk->staged[CHUNK + p],
                     ay = chunk->staged[2 * CHUNK + p], az = chunk->staged[3 * CHUNK + p];
        float w = weigh(of_z, az.w) * weigh(of_y, ay.w) * weigh(of_x, ax.w);
        if (several && chunk->tiles[p] != t) w = 0.0f;
        const float3 momentum =
            fma((float3)(k), az.xyz, fma((float3)(j), ay.xyz, fma((float3)(i), ax.xyz, start.xyz)));
        sum = fma((float4)(w), (float4)(momentum, start.w), sum);
      }
      if (i > 0) continue;
      sums[9 * x] = sum;
      sum = 0.0f;
    }
    if (third < 2) sums[9 * (6 + third)] = sum;
  }
}

// Returns what the rows of a slab give to a node of the tile.
static inline float4 from_rows(local const Chunk* chunk, int slab, int node) {
  const int x = node % 8, y = node / 8 % 8, z = node / 64 - SLAB_LAYERS * slab;
  float4 sum = 0.0f;
  for (int layer = 0; layer < SLAB_LAYERS; ++layer)
    for (int j = 0; j < 3; ++j) {
      const int k = z - layer;
      if (k >= 0 && k < 3 && y - j >= 0 && y - j < 6)
        sum += chunk->phase.sums[ROW_NODES * (6 * layer + y - j) + 9 * x + j + 3 * k];
    }
  return sum;
}

#endif  // NAVVY_KERNELS_SOIL_GROUPS_CHUNK_H
