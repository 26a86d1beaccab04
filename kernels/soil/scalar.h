// SPDX-License-Identifier: Apache-2.0
// The dialect of kernels/README.md for one particle or node per work-item, or per iteration of a
// loop.
#ifndef NAVVY_KERNELS_SOIL_SCALAR_H
#define NAVVY_KERNELS_SOIL_SCALAR_H

#include "common/portable.h"
#include "soil/layout.h"

typedef float real;
typedef int ints;
typedef float scalar;
typedef float3 scalar3;
typedef float4 columns;
#define INLINED static inline

static inline int some(int yes) { return yes; }
static inline float mean_of(float4 t) { return 0.25f * ((t.x + t.y) + (t.z + t.w)); }

#endif  // NAVVY_KERNELS_SOIL_SCALAR_H
