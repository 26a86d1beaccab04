// SPDX-License-Identifier: Apache-2.0
// Velocities and masses of nodes, four along x at a time: a float16 holds (v, m) of each.
#ifndef NAVVY_KERNELS_SOIL_LANES_NODE_ROWS_H
#define NAVVY_KERNELS_SOIL_LANES_NODE_ROWS_H

#include "soil/lanes/lanes.h"
#include "soil/node.h"

// Returns v = p / m + g dt of four nodes, added to the velocity before in a held step. Nodes
// lighter than a mass quantum are empty.
static inline float16 velocity_of(float16 momentum, float4 dv, int hold,
                                  global const float* before) {
  const float4 m = momentum.s37bf;
  const float4 inv = INVERSE_MASS(m);
  const float4 on = select((float4)(0.0f), (float4)(1.0f), m > MASS_QUANTUM);
  float16 v = momentum * (float16)(inv.xxxx, inv.yyyy, inv.zzzz, inv.wwww) +
              (float16)(dv * on.x, dv * on.y, dv * on.z, dv * on.w);
  if (hold)
    v += vload16(0, before) *
         (float16)((float4)(on.x), (float4)(on.y), (float4)(on.z), (float4)(on.w));
  return (float16)(v.s012, m.x, v.s456, m.y, v.s89a, m.z, v.scde, m.w);
}

// Sets the velocity of nodes at or below the floor to 0, for a row of four, except that the topmost
// of them lets soil fall that is not on the ground yet [docs/soil.md, resting ground]; divides
// masses by the free volume above the ground [docs/soil.md, free volume]. above: masses of the
// nodes above the row; last: the row after the step before, whose masses are kept if renew is 0.
static inline float16 held(float16 v, float4 above, float16 last, int renew,
                           global const BlockFloor* ground, int row) {
  const float z = (float)(row >> 2);
  const float4 top = vload4(row & 3, ground->held);
  const int4 fixed = z <= top, topmost = fixed && z + 1.0f > top;
  const float4 on = select((float4)(1.0f), (float4)(0.0f), fixed);
  const float16 below = z - vload16(row & 3, ground->around[0]);
  float4 up = v.s26ae * on;
  if (any(topmost)) {
    const float4 falls = (float4)(falling_share(v.s3, above.x, below.lo.lo),  //
                                  falling_share(v.s7, above.y, below.lo.hi),  //
                                  falling_share(v.sb, above.z, below.hi.lo),  //
                                  falling_share(v.sf, above.w, below.hi.hi));
    up = select(up, fmin(v.s26ae, 0.0f) * falls, topmost);
  }
  float4 mass = last.s37bf;
  if (renew)
    mass = v.s37bf * (float4)(1.0f / free_fraction_above(below.lo.lo),  //
                              1.0f / free_fraction_above(below.lo.hi),  //
                              1.0f / free_fraction_above(below.hi.lo),  //
                              1.0f / free_fraction_above(below.hi.hi));
  return (float16)(v.s01 * on.x, up.x, mass.x, v.s45 * on.y, up.y, mass.y,  //
                   v.s89 * on.z, up.z, mass.z, v.scd * on.w, up.w, mass.w);
}

// Returns true when no node of the block is held or has ground in its kernel.
static inline bool far_above(global const BlockFloor* ground) {
  float16 highest = vload16(0, ground->around[0]) + 1.5f;
  for (int i = 1; i < 4; ++i) highest = fmax(highest, vload16(i, ground->around[0]) + 1.5f);
  return !some(fmax(highest, vload16(0, ground->held)) >= 0.0f);
}

#endif  // NAVVY_KERNELS_SOIL_LANES_NODE_ROWS_H
