// SPDX-License-Identifier: Apache-2.0
// Basis of the kernels in kernels/soil/groups, in which each work-item computes one particle or
// node: the scalar counterpart of soil/lanes/lanes.h. Soil law and shell queries are the same
// sources in both schedules.
#ifndef NAVVY_KERNELS_SOIL_GROUPS_GROUP_H
#define NAVVY_KERNELS_SOIL_GROUPS_GROUP_H

#include "soil/scalar.h"
#include "common/group_index.h"

// Unrolls the loop that follows. Loops over small private arrays are unrolled so that the arrays
// become registers, which a GPU cannot index.
#define UNROLL _Pragma("unroll")
// Unrolls the loop that follows by four, so that its loads from local memory overlap.
#define UNROLL_BY_FOUR _Pragma("unroll 4")

// TILE_SIZE: number of nodes of a tile (8 x 8 x 8 nodes around a block) without padding. CELLS:
// number of cells of a tile that can contain the base node of a particle: -1 .. 4 along each axis,
// x fastest.
#define TILE_SIZE 512
#define CELLS 216

// Access to particle fields, for kernels that name their arguments `state` and `capacity` and have
// a variable `slot`. LOAD and STORE read and write one field. LOAD_ONE, LOAD_MANY, STORE_ONE and
// STORE_MANY are the arguments of a field list (particle_fields.h) and copy all of its fields to or
// from the struct `soil_state`.
#define LOAD(field) state[(size_t)(field)*capacity + (slot)]
#define STORE(field, value) state[(size_t)(field)*capacity + (slot)] = (value)
#define LOAD_ONE(NAME, member, rest) soil_state.member = LOAD(FIELD_##NAME);
#define LOAD_MANY(NAME, member, count, rest) \
  UNROLL for (int k_ = 0; k_ < (count); ++k_) soil_state.member[k_] = LOAD(FIELD_##NAME + k_);
#define STORE_ONE(NAME, member, rest) STORE(FIELD_##NAME, soil_state.member);
#define STORE_MANY(NAME, member, count, rest) \
  UNROLL for (int k_ = 0; k_ < (count); ++k_) STORE(FIELD_##NAME + k_, soil_state.member[k_]);

// Raises `largest`, which holds the bits of a float, to `value` if that is larger. Both must be >=
// 0 or infinite: such floats have the same order as their bits, and atomics exist for integers
// only.
static inline void atomic_max_nonnegative(local int* largest, float value) {
  atomic_max(largest, as_int(value));
}

#endif  // NAVVY_KERNELS_SOIL_GROUPS_GROUP_H
