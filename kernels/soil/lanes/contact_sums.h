// SPDX-License-Identifier: Apache-2.0
// Sums over the contacts of a tool in vectors, for soil/contact_node.h, which is to be included
// after this file.
#ifndef NAVVY_KERNELS_SOIL_LANES_CONTACT_SUMS_H
#define NAVVY_KERNELS_SOIL_LANES_CONTACT_SUMS_H

#include "soil/lanes/lanes.h"

#ifdef SUMS
#error "include soil/lanes/contact_sums.h before soil/contact_node.h"
#endif

// Sums over contacts as whole vectors, which stay in registers: moment and force in six words of
// `wrench`, the upper triangle of the stiffness, row by row, in the words of the others.
typedef struct {
  float8 wrench;
  float16 rows;
  float4 rest;
  float last;
} LaneSums;

#define SUMS LaneSums

// As the functions of soil/contact_node.h.
INLINED void add_wrench(SUMS* sums, float3 moment, float3 force) {
  sums->wrench += (float8)(moment, force, 0.0f, 0.0f);
}

INLINED void add_outer(SUMS* sums, float held, float3 moment, float3 d) {
  const float8 g = (float8)(moment, d, 0.0f, 0.0f);
  const float16 all = (float16)(g, g);
  sums->rows += held * PICK(all, all, 0, 0, 0, 0, 0, 0, 1, 1, 1, 1, 1, 2, 2, 2, 2, 3) *
                PICK(all, all, 0, 1, 2, 3, 4, 5, 1, 2, 3, 4, 5, 2, 3, 4, 5, 3);
  sums->rest += held * g.s3344 * g.s4545;
  sums->last += held * g.s5 * g.s5;
}

INLINED void add_axes(SUMS* sums, float m, float3 r) {
  add_outer(sums, m, (float3)(0.0f, r.z, -r.y), (float3)(1.0f, 0.0f, 0.0f));
  add_outer(sums, m, (float3)(-r.z, 0.0f, r.x), (float3)(0.0f, 1.0f, 0.0f));
  add_outer(sums, m, (float3)(r.y, -r.x, 0.0f), (float3)(0.0f, 0.0f, 1.0f));
}

#endif  // NAVVY_KERNELS_SOIL_LANES_CONTACT_SUMS_H
