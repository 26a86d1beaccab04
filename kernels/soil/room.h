// SPDX-License-Identifier: Apache-2.0
// How much of a node's kernel soil can fill: resting ground and plates take the rest. Node masses divided by it tell how
// densely soil is packed right up to walls, where plain sums would read half.
#ifndef NAVVY_KERNELS_SOIL_ROOM_H
#define NAVVY_KERNELS_SOIL_ROOM_H

#define LEAST_ROOM 0.25f  // a sliver tells nothing

// Share of the quadratic B-spline of a node that lies on its side of a plane t cells away (t < 0: node behind it).
static inline float4 kernel_share(float4 t) {
  const float4 a = clamp(t, -0.5f, 0.5f);
  const float4 low = clamp(1.5f + t, 0.0f, 1.0f), high = clamp(1.5f - t, 0.0f, 1.0f);
  return 0.5f + a * (0.75f - a * a * (1.0f / 3.0f)) + (low * low * low - high * high * high) * (1.0f / 6.0f);
}

// The same for a node among four columns that end `below` cells under it (or above, when negative), and on its side of
// a plate `beside` cells away. Never less than LEAST_ROOM.
static inline float room_between(float4 below, float beside) {
  const float4 above = kernel_share(below);
  return fmax(0.25f * ((above.x + above.y) + (above.z + above.w)) * kernel_share((float4)(beside)).x, LEAST_ROOM);
}

static inline float room_above(float4 below) { return all(below >= 1.5f) ? 1.0f : room_between(below, 1.5f); }

#endif  // NAVVY_KERNELS_SOIL_ROOM_H
