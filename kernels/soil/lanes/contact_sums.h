// SPDX-License-Identifier: Apache-2.0
// Sums over the contacts of a tool in vectors, for soil/contact_node.h, which is to be included
// after this file.
#ifndef NAVVY_KERNELS_SOIL_LANES_CONTACT_SUMS_H
#define NAVVY_KERNELS_SOIL_LANES_CONTACT_SUMS_H

#include "soil/lanes/lanes.h"

#ifdef ADD_OUTER
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

// Adds held g g^T to the stiffness: words 0 .. 5 of g.
INLINED void add_outer(LaneSums* sums, float held, float8 g) {
  const float16 all = (float16)(g, g);
  sums->rows += held * PICK(all, all, 0, 0, 0, 0, 0, 0, 1, 1, 1, 1, 1, 2, 2, 2, 2, 3) *
                PICK(all, all, 0, 1, 2, 3, 4, 5, 1, 2, 3, 4, 5, 2, 3, 4, 5, 3);
  sums->rest += held * g.s3344 * g.s4545;
  sums->last += held * g.s5 * g.s5;
}

// Adds m g g^T with g = (r x axis, axis) for each axis of W.
INLINED void add_axes(LaneSums* sums, float m, float3 r) {
  add_outer(sums, m, (float8)(0.0f, r.z, -r.y, 1.0f, 0.0f, 0.0f, 0.0f, 0.0f));
  add_outer(sums, m, (float8)(-r.z, 0.0f, r.x, 0.0f, 1.0f, 0.0f, 0.0f, 0.0f));
  add_outer(sums, m, (float8)(r.y, -r.x, 0.0f, 0.0f, 0.0f, 1.0f, 0.0f, 0.0f));
}

#define SUMS LaneSums
#define ADD_WRENCH(sums, l, j) (sums)->wrench += (float8)((l), (j), 0.0f, 0.0f)
#define ADD_OUTER(sums, held, moment, d) \
  add_outer((sums), (held), (float8)((moment), (d), 0.0f, 0.0f))
#define ADD_AXES add_axes

#endif  // NAVVY_KERNELS_SOIL_LANES_CONTACT_SUMS_H
