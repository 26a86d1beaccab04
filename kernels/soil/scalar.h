// SPDX-License-Identifier: Apache-2.0
// The dialect of kernels/README.md for one particle or node per work-item, or per iteration of a
// loop.
#ifndef NAVVY_KERNELS_SOIL_SCALAR_H
#define NAVVY_KERNELS_SOIL_SCALAR_H

#include "common/portable.h"
#include "soil/layout.h"

// Type of a particle's numbers, of conditions, of uniform values, and of numbers per column.
typedef float real;
typedef int ints;
typedef float scalar;
typedef float3 scalar3;
typedef float4 columns;
#define INLINED static inline

// Returns whether any lane of a condition is true; here there is one.
static inline int some(int yes) { return yes; }
// Returns the mean over the four columns around a node.
static inline float mean_of(float4 t) { return 0.25f * ((t.x + t.y) + (t.z + t.w)); }

#endif  // NAVVY_KERNELS_SOIL_SCALAR_H
