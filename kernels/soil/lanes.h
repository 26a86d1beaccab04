// SPDX-License-Identifier: Apache-2.0
// Sixteen lanes at a time: loads, weights, and the turn between "one component of 16 particles" and "4 components of
// one particle". PoCL's own vectoriser gives up on kernels like ours, so float16 is written out (it maps to AVX-512 or
// to pairs of AVX2 registers); other devices split it as they like.
#ifndef NAVVY_KERNELS_SOIL_LANES_H
#define NAVVY_KERNELS_SOIL_LANES_H

// float16 arguments of built-ins are inlined; that they would be passed in memory on AVX2 is no news worth printing.
#pragma clang diagnostic ignored "-Wpsabi"

#include "common/portable.h"
#include "soil/layout.h"


typedef float16 real;
#define LAW_T float16
#define LAW_LIT(x) ((float)(x))
#define LAW_MIN(a, b) fmin(a, b)
#define LAW_MAX(a, b) fmax(a, b)
#define LAW_SQRT(a) sqrt(a)
#define LAW_STEP(edge, x) step((float16)(edge), x)
#define LAW_FN static inline


// Rows r0..r3 hold components 0..3 of 16 particles. Afterwards o0..o3 hold float4s: the one of particle 4 q + i is
// part q of o_i. Applied again it undoes itself.
#define TRANSPOSE4(r0, r1, r2, r3, o0, o1, o2, o3)                                                                    \
  do {                                                                                                                \
    const float16 t0_ = (float16)(r0.s0, r1.s0, r0.s1, r1.s1, r0.s4, r1.s4, r0.s5, r1.s5, r0.s8, r1.s8, r0.s9, r1.s9, \
                                  r0.sc, r1.sc, r0.sd, r1.sd);                                                        \
    const float16 t1_ = (float16)(r0.s2, r1.s2, r0.s3, r1.s3, r0.s6, r1.s6, r0.s7, r1.s7, r0.sa, r1.sa, r0.sb, r1.sb, \
                                  r0.se, r1.se, r0.sf, r1.sf);                                                        \
    const float16 t2_ = (float16)(r2.s0, r3.s0, r2.s1, r3.s1, r2.s4, r3.s4, r2.s5, r3.s5, r2.s8, r3.s8, r2.s9, r3.s9, \
                                  r2.sc, r3.sc, r2.sd, r3.sd);                                                        \
    const float16 t3_ = (float16)(r2.s2, r3.s2, r2.s3, r3.s3, r2.s6, r3.s6, r2.s7, r3.s7, r2.sa, r3.sa, r2.sb, r3.sb, \
                                  r2.se, r3.se, r2.sf, r3.sf);                                                        \
    o0 = (float16)(t0_.s01, t2_.s01, t0_.s45, t2_.s45, t0_.s89, t2_.s89, t0_.scd, t2_.scd);                           \
    o1 = (float16)(t0_.s23, t2_.s23, t0_.s67, t2_.s67, t0_.sab, t2_.sab, t0_.sef, t2_.sef);                           \
    o2 = (float16)(t1_.s01, t3_.s01, t1_.s45, t3_.s45, t1_.s89, t3_.s89, t1_.scd, t3_.scd);                           \
    o3 = (float16)(t1_.s23, t3_.s23, t1_.s67, t3_.s67, t1_.sab, t3_.sab, t1_.sef, t3_.sef);                           \
  } while (0)

// Field of the 16 slots from `at`, in kernels that name their arguments state and capacity.
#define LOAD(field) vload16(0, state + (size_t)(field) * capacity + at)
#define STORE(field, value) vstore16(value, 0, state + (size_t)(field) * capacity + at)

// Turns four rows into 16 float4s in `part`, and back.
#define TURN(part, a, b, c, d)                    \
  do {                                            \
    float16 o0_, o1_, o2_, o3_;                   \
    TRANSPOSE4(a, b, c, d, o0_, o1_, o2_, o3_);   \
    vstore16(o0_, 0, part);                       \
    vstore16(o1_, 1, part);                       \
    vstore16(o2_, 2, part);                       \
    vstore16(o3_, 3, part);                       \
  } while (0)
#define UNTURN(part, a, b, c, d)                                                   \
  do {                                                                             \
    const float16 i0_ = vload16(0, part), i1_ = vload16(1, part);                  \
    const float16 i2_ = vload16(2, part), i3_ = vload16(3, part);                  \
    TRANSPOSE4(i0_, i1_, i2_, i3_, a, b, c, d);                                    \
  } while (0)

// Slot of particle l among the float4s of a turned pack.
static inline int turned(int l) { return (l & 3) * 4 + (l >> 2); }

// Quadratic B-spline over nodes base, base+1, base+2 where base = floor(x - 0.5) and f = x - base in [0.5, 1.5).
static inline void spline(real f, real* w0, real* w1, real* w2) {
  const real a = 1.5f - f, b = f - 1.0f, c = f - 0.5f;
  *w0 = 0.5f * a * a;
  *w1 = 0.75f - b * b;
  *w2 = 0.5f * c * c;
}

// Offset of neighbour n of 27, x fastest, each axis -1, 0, 1.
static inline int3 neighbour_offset(int n) { return (int3)(n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1); }

// Base node of a coordinate, kept inside the tile even for a NaN (the host stops the run, the kernel must not stray).
static inline real base_node(real x) { return fmin(fmax(floor(x - 0.5f), -1.0f), 4.0f); }

#endif  // NAVVY_KERNELS_SOIL_LANES_H
