// SPDX-License-Identifier: Apache-2.0
// The arithmetic of one node: how much of its kernel soil can fill, and what momentum makes of a
// velocity. One source for both schedules, the native loop and the double twin.
//
// Resting ground and plates take room: node masses divided by what is left tell how densely soil is
// packed right up to walls, where plain sums would read half [docs/soil.md, room]. `columns` is a
// number for each of the four columns around a node (float4); on the host, where the ground is
// level, it is one.
#ifndef NAVVY_KERNELS_SOIL_NODE_H
#define NAVVY_KERNELS_SOIL_NODE_H

#include "soil/layout.h"

#define MIN_FREE_FRACTION 0.25f  // a sliver tells nothing

// Share of the quadratic B-spline of a node that lies on its side of a plane t cells away (t < 0:
// node behind it).
INLINED columns kernel_share(columns t) {
  const columns a = clamp(t, -0.5f, 0.5f);
  const columns low = clamp(1.5f + t, 0.0f, 1.0f), high = clamp(1.5f - t, 0.0f, 1.0f);
  return 0.5f + a * (0.75f - a * a * (scalar)(1.0 / 3.0)) +
         (low * low * low - high * high * high) * (scalar)(1.0 / 6.0);
}

// The same for a node whose four columns end `below` cells under it (or above, when negative), on
// its side of a plate `beside` cells away. Never less than MIN_FREE_FRACTION.
INLINED scalar free_fraction_between(columns below, scalar beside) {
  return fmax(mean_of(kernel_share(below)) * mean_of(kernel_share((columns)(beside))), MIN_FREE_FRACTION);
}

INLINED scalar free_fraction_above(columns below) { return all(below >= 1.5f) ? 1.0f : free_fraction_between(below, 1.5f); }

// 1 / m [1/kg] of a node, or of several side by side; 0 for one lighter than a mass quantum, which
// is empty: velocity after gravity is p INVERSE_MASS(m) + g dt where m > MASS_QUANTUM.
#define INVERSE_MASS(m) ((m) > MASS_QUANTUM ? 1.0f / (m) : 0.0f)

#endif  // NAVVY_KERNELS_SOIL_NODE_H
