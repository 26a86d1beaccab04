// SPDX-License-Identifier: Apache-2.0
// Basis of the kernels in kernels/soil/lanes, in which each work-item computes sixteen particles at
// a time: loads, weights, and the transpose between "one component of 16 particles" and "4
// components of one particle".
//
// PoCL's vectoriser fails on kernels like these, so float16 is written out. It maps to AVX-512
// registers or to pairs of AVX2 registers; other devices split it as they like.
#ifndef NAVVY_KERNELS_SOIL_LANES_H
#define NAVVY_KERNELS_SOIL_LANES_H

// float16 arguments of built-ins are inlined, so how AVX2 would pass them does not matter.
#pragma clang diagnostic ignored "-Wpsabi"

#include "common/portable.h"
#include "common/group_index.h"
#include "soil/layout.h"

// Types of the dialect of kernels/README.md: real and ints hold one value for each of sixteen
// particles, scalar and scalar3 one value for all of them, columns one value for each of the four
// columns around a node.
typedef float16 real;
typedef int16 ints;
typedef float scalar;
typedef float3 scalar3;
typedef float4 columns;

// Unrolls the loop that follows, so that a particle's rows of nodes stay in registers.
#define UNROLL _Pragma("unroll")
#define INLINED static inline __attribute__((always_inline))

// Stores sixteen values at once. PoCL cuts vstore16 into four stores and three shuffles, so the
// values are assigned to a vector that may lie at any address of a float.
typedef float16 __attribute__((aligned(4))) loose16;
#define PUT16(value, at) (*(global loose16*)(at) = (value))

// As in scalar.h. PoCL makes four instructions of fmin and fmax, and twelve of floor.
INLINED float16 smaller(float16 a, float16 b) { return a < b ? a : b; }
INLINED float16 larger(float16 a, float16 b) { return a > b ? a : b; }
INLINED float16 floored(float16 x) {
#ifdef __has_builtin
#if __has_builtin(__builtin_elementwise_floor)
  return __builtin_elementwise_floor(x);
#else
  return floor(x);
#endif
#else
  return floor(x);
#endif
}

// Picks lanes of two vectors. Written as single lanes, or as shuffle2, PoCL makes three times as
// many instructions.
#ifdef __has_builtin
#if __has_builtin(__builtin_shufflevector)
#define PICK(a, b, ...) __builtin_shufflevector(a, b, __VA_ARGS__)
#endif
#endif
#ifndef PICK
#define PICK(a, b, ...) shuffle2(a, b, (uint16)(__VA_ARGS__))
#endif
#define PICK_LOW(a, b) PICK(a, b, 0, 16, 1, 17, 4, 20, 5, 21, 8, 24, 9, 25, 12, 28, 13, 29)
#define PICK_HIGH(a, b) PICK(a, b, 2, 18, 3, 19, 6, 22, 7, 23, 10, 26, 11, 27, 14, 30, 15, 31)
#define PICK_LOW2(a, b) PICK(a, b, 0, 1, 16, 17, 4, 5, 20, 21, 8, 9, 24, 25, 12, 13, 28, 29)
#define PICK_HIGH2(a, b) PICK(a, b, 2, 3, 18, 19, 6, 7, 22, 23, 10, 11, 26, 27, 14, 15, 30, 31)

// Transposes the rows r0 .. r3, which hold components 0 .. 3 of 16 particles. Afterwards o0 .. o3
// hold float4s with the components of one particle each: particle 4 q + i is the q-th float4 of
// o_i. The operation is its own inverse.
#define TRANSPOSE4(r0, r1, r2, r3, o0, o1, o2, o3)                 \
  do {                                                             \
    const float16 t0_ = PICK_LOW(r0, r1), t1_ = PICK_HIGH(r0, r1); \
    const float16 t2_ = PICK_LOW(r2, r3), t3_ = PICK_HIGH(r2, r3); \
    o0 = PICK_LOW2(t0_, t2_);                                      \
    o1 = PICK_HIGH2(t0_, t2_);                                     \
    o2 = PICK_LOW2(t1_, t3_);                                      \
    o3 = PICK_HIGH2(t1_, t3_);                                     \
  } while (0)

// Access to the fields of the 16 particles from `slot` on, for kernels that name their arguments
// `state` and `capacity` and have a variable `slot`. LOAD and STORE read and write one field.
// LOAD_ONE, LOAD_MANY, STORE_ONE and STORE_MANY are the arguments of a field list
// (particle_fields.h) and copy all of its fields to or from the struct `soil_state`.
#define LOAD(field) vload16(0, state + (size_t)(field)*capacity + slot)
#define STORE(field, value) PUT16(value, state + (size_t)(field)*capacity + slot)
#define LOAD_ONE(NAME, member, rest) soil_state.member = LOAD(FIELD_##NAME);
#define LOAD_MANY(NAME, member, count, rest) \
  for (int k_ = 0; k_ < (count); ++k_) soil_state.member[k_] = LOAD(FIELD_##NAME + k_);
#define STORE_ONE(NAME, member, rest) STORE(FIELD_##NAME, soil_state.member);
#define STORE_MANY(NAME, member, count, rest) \
  for (int k_ = 0; k_ < (count); ++k_) STORE(FIELD_##NAME + k_, soil_state.member[k_]);

// Prefetches a field of the fourth pack ahead: thirty arrays are more streams than a processor
// follows by itself. Does nothing where the compiler has no such built-in.
#ifdef __has_builtin
#if __has_builtin(__builtin_prefetch)
#define SOON(field)   \
  __builtin_prefetch( \
      (const void*)(size_t)(state + (size_t)(field)*capacity + slot + 4 * NAVVY_LANES))
#endif
#endif
#ifndef SOON
#define SOON(field)
#endif

// TURN transposes four rows a .. d into 16 float4s and stores them in `part`; UNTURN does the
// reverse.
#define TURN(part, a, b, c, d)                  \
  do {                                          \
    float16 o0_, o1_, o2_, o3_;                 \
    TRANSPOSE4(a, b, c, d, o0_, o1_, o2_, o3_); \
    vstore16(o0_, 0, part);                     \
    vstore16(o1_, 1, part);                     \
    vstore16(o2_, 2, part);                     \
    vstore16(o3_, 3, part);                     \
  } while (0)
#define UNTURN(part, a, b, c, d)                                  \
  do {                                                            \
    const float16 i0_ = vload16(0, part), i1_ = vload16(1, part); \
    const float16 i2_ = vload16(2, part), i3_ = vload16(3, part); \
    TRANSPOSE4(i0_, i1_, i2_, i3_, a, b, c, d);                   \
  } while (0)

// Returns true if the comparison `lanes` is true in any lane. It replaces any(), which PoCL
// evaluates one lane after another.
static inline bool some(int16 lanes) {
  const int8 eight = lanes.lo | lanes.hi;
  const int4 four = eight.lo | eight.hi;
  return ((four.x | four.y) | (four.z | four.w)) != 0;
}

// Velocities or momenta at the 3 x 3 x 4 nodes around the particles of one cell. Particles are
// sorted by cell, so the rows stay in registers until the cell changes.
typedef struct Rows {
  // Row 3 k + j holds four nodes along x, at j nodes above the base node along y and k along z.
  float16 row[9];
} Rows;

// Returns the position of particle l (0 .. 15) among the float4s that TURN stores.
static inline int turned(int l) { return (l & 3) * 4 + (l >> 2); }

// Returns the index in the tile (8 x 8 x 8 nodes) of the base node with coordinates (bx, by, bz)
// from base_node().
static inline int16 tile_node(real bx, real by, real bz) {
  return convert_int16(bx) + 1 + 8 * (convert_int16(by) + 1) + 64 * (convert_int16(bz) + 1);
}

// Returns the mean of a value over the four columns around a node.
static inline float mean_of(float4 t) { return 0.25f * ((t.x + t.y) + (t.z + t.w)); }

#endif  // NAVVY_KERNELS_SOIL_LANES_H
