// SPDX-License-Identifier: Apache-2.0
// The dialect of kernels/README.md for one particle or node at a time: one per work-item, or one
// per iteration of a loop.
#ifndef NAVVY_KERNELS_SOIL_SCALAR_H
#define NAVVY_KERNELS_SOIL_SCALAR_H

#include "common/portable.h"
#include "soil/layout.h"

// Types of the dialect. real: a value of a particle; ints: a condition or an index of a particle;
// scalar, scalar3: a value that is the same for all particles; columns: one value for each of the
// four columns around a node.
typedef float real;
typedef int ints;
typedef float scalar;
typedef float3 scalar3;
typedef float4 columns;
#define INLINED static inline

// Return the smaller and the larger of two values, and the second one if either is NaN: a single
// instruction, unlike fmin and fmax, which must return the one that is a number.
static inline float smaller(float a, float b) { return a < b ? a : b; }
static inline float larger(float a, float b) { return a > b ? a : b; }
// Returns the largest whole number that is not above x.
static inline float floored(float x) { return floor(x); }
// Returns true if a condition holds for any of the particles computed at a time; here there is only
// one.
static inline int some(int yes) { return yes; }
// Returns the mean of a value over the four columns around a node.
static inline float mean_of(float4 t) { return 0.25f * ((t.x + t.y) + (t.z + t.w)); }

#endif  // NAVVY_KERNELS_SOIL_SCALAR_H
