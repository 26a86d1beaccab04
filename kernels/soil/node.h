// SPDX-License-Identifier: Apache-2.0
// Arithmetic of one node: the fraction of its kernel that soil can fill, and the inverse of its
// mass. One source for both schedules, the native loop and the double twin.
//
// Resting ground and plates occupy part of a node's kernel. Node masses divided by the free
// fraction show how densely soil is packed right up to walls, where plain sums would show half
// [docs/soil.md, free volume]. `columns` holds one number for each of the four columns around a
// node (float4). On the host, where the ground is level, it is one number.
#ifndef NAVVY_KERNELS_SOIL_NODE_H
#define NAVVY_KERNELS_SOIL_NODE_H

#include "soil/layout.h"

// Returns the fraction of a node's quadratic B-spline on its side of a plane at distance t [cells]
// (t < 0: the node is behind the plane).
INLINED columns kernel_share(columns t) {
  const columns a = clamp(t, -0.5f, 0.5f);
  const columns low = clamp(1.5f + t, 0.0f, 1.0f), high = clamp(1.5f - t, 0.0f, 1.0f);
  return 0.5f + a * (0.75f - a * a * (scalar)(1.0 / 3.0)) +
         (low * low * low - high * high * high) * (scalar)(1.0 / 6.0);
}

// Returns the free fraction of a node whose four columns end `below` cells under it (above it if
// negative), on its side of a plate at distance `beside` [cells]. At least
// SCHEME(min_free_fraction).
INLINED scalar free_fraction_between(columns below, scalar beside) {
  return fmax(mean_of(kernel_share(below)) * mean_of(kernel_share((columns)(beside))),
              SCHEME(min_free_fraction));
}

INLINED scalar free_fraction_above(columns below) {
  return all(below >= 1.5f) ? 1.0f : free_fraction_between(below, 1.5f);
}

// 1 / m [1/kg] of a node, or of several nodes at once; 0 for a node lighter than a mass quantum,
// which is empty. The velocity after gravity is p INVERSE_MASS(m) + g dt where m > MASS_QUANTUM.
#define INVERSE_MASS(m) ((m) > MASS_QUANTUM ? 1.0f / (m) : 0.0f)

#endif  // NAVVY_KERNELS_SOIL_NODE_H
