// SPDX-License-Identifier: Apache-2.0
// One particle or node per work-item: the scalar counterpart of soil/lanes/lanes.h for the schedule of work-groups. Law and
// shell queries are the same sources in both.
#ifndef NAVVY_KERNELS_SOIL_GROUPS_GROUP_H
#define NAVVY_KERNELS_SOIL_GROUPS_GROUP_H

#include "common/portable.h"
#include "soil/layout.h"

typedef float real;
typedef int ints;
#define LAW_T float
#define LAW_LIT(x) ((float)(x))
#define LAW_MIN(a, b) fmin(a, b)
#define LAW_MAX(a, b) fmax(a, b)
#define LAW_SQRT(a) sqrt(a)
#define LAW_STEP(edge, x) step((float)(edge), x)
#define LAW_FN static inline

// Loops over a work-item's own small arrays are unrolled: then these are registers, which a GPU cannot index.
#define UNROLL _Pragma("unroll")

// Tile nodes without the pad, and the cells of base nodes -1..4 in a tile, x fastest.
#define TILE_SIZE 512
#define CELLS 216

// Field of slot `at`, in kernels that name their arguments state and capacity.
#define LOAD(field) state[(size_t)(field)*capacity + (at)]
#define STORE(field, value) state[(size_t)(field)*capacity + (at)] = (value)

static inline int some(int yes) { return yes; }

// Quadratic B-spline over nodes base, base+1, base+2 where base = floor(x - 0.5) and f = x - base in [0.5, 1.5).
static inline void spline(float f, float* w) {
  const float a = 1.5f - f, b = f - 1.0f, c = f - 0.5f;
  w[0] = 0.5f * a * a;
  w[1] = 0.75f - b * b;
  w[2] = 0.5f * c * c;
}

// Offset of neighbour n of 27, x fastest, each axis -1, 0, 1.
static inline int3 neighbour_offset(int n) { return (int3)(n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1); }

// Base node of a coordinate, kept inside the tile even for a NaN (the host stops the run, the kernel must not stray).
static inline float base_node(float x) { return fmin(fmax(floor(x - 0.5f), -1.0f), 4.0f); }

// Number of the cell of base nodes, and of the base node in the tile.
static inline int cell_of(float x, float y, float z) {
  return (int)base_node(x) + 1 + 6 * ((int)base_node(y) + 1) + 36 * ((int)base_node(z) + 1);
}

// Tile of a particle's side (1 + 2 tool + behind): 0 neutral, 1 front, 2 back.
static inline int tile_of(int tag) {
  const int side = tag >> 16;
  return side > 0 ? 2 - (side & 1) : 0;
}

// Largest of values >= 0 (or infinite) in a work-group: the order of their bits is theirs, and integers have atomics.
static inline void keep_largest(local int* largest, float value) { atomic_max(largest, as_int(value)); }

#endif  // NAVVY_KERNELS_SOIL_GROUPS_GROUP_H
