// SPDX-License-Identifier: Apache-2.0
// One particle or node per work-item: the scalar counterpart of soil/lanes/lanes.h for the schedule
// of work-groups. Law and shell queries are the same sources in both.
#ifndef NAVVY_KERNELS_SOIL_GROUPS_GROUP_H
#define NAVVY_KERNELS_SOIL_GROUPS_GROUP_H

#include "soil/scalar.h"

// Loops over a work-item's own small arrays are unrolled: only then are they registers, which a GPU
// cannot index.
#define UNROLL _Pragma("unroll")

// Tile nodes without padding, and cells of the base nodes -1..4 in a tile, x fastest.
#define TILE_SIZE 512
#define CELLS 216

// Field of `slot`, in kernels that name their arguments state and capacity, and all fields of a
// list (particle_fields.h) into or out of a struct.
#define LOAD(field) state[(size_t)(field)*capacity + (slot)]
#define STORE(field, value) state[(size_t)(field)*capacity + (slot)] = (value)
#define LOAD_ONE(NAME, member, rest) soil_state.member = LOAD(FIELD_##NAME);
#define LOAD_MANY(NAME, member, count, rest) \
  UNROLL for (int k_ = 0; k_ < (count); ++k_) soil_state.member[k_] = LOAD(FIELD_##NAME + k_);
#define STORE_ONE(NAME, member, rest) STORE(FIELD_##NAME, soil_state.member);
#define STORE_MANY(NAME, member, count, rest) \
  UNROLL for (int k_ = 0; k_ < (count); ++k_) STORE(FIELD_##NAME + k_, soil_state.member[k_]);

// Raises `largest` to `value` if that is larger, for values >= 0 or infinite: the order of such
// floats is the order of their bits, and integers have atomics.
static inline void atomic_max_nonnegative(local int* largest, float value) {
  atomic_max(largest, as_int(value));
}

#endif  // NAVVY_KERNELS_SOIL_GROUPS_GROUP_H
