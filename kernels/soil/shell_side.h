// SPDX-License-Identifier: Apache-2.0
// What one node or particle learns from the closest feature of a shell (soil/shell_query.h): signed distance, normal,
// side.
#ifndef NAVVY_KERNELS_SOIL_SHELL_SIDE_H
#define NAVVY_KERNELS_SOIL_SHELL_SIDE_H

#include "soil/shell_query.h"

// What one point learns from its closest feature. Normal points to the front.
static inline bool resolve(global const float4* triangles, int feature, float3 away, float distance2, float* phi,
                           float3* normal, bool* rim) {
  if (feature < 0) return false;
  const float4 pseudo = triangles[SHELL_WORDS * (feature >> 3) + SHELL_NORMAL + (feature & 7)];
  const float d = sqrt(distance2);
  const float sign = dot(away, pseudo.xyz) >= 0.0f ? 1.0f : -1.0f;
  *phi = sign * d;
  // On the plate itself the direction is the plate's.
  *normal = d > 1e-4f ? away * (sign / d) : triangles[SHELL_WORDS * (feature >> 3) + SHELL_NORMAL].xyz;
  *rim = pseudo.w > 0.0f;
  return true;
}

// One particle near a shell. side = 1 + 2 tool + behind, 0: none.
typedef struct Kept {
  float3 x;  // position [cells from its block's corner]
  int side;
  float push;  // out of the plate [cells]
  int crossed;
} Kept;

// The side of a particle of block `key` whose closest feature is `feature` at `closest`; a particle that sank into the
// plate comes back to its surface.
static inline Kept keep_side(float3 x, int old_side, int3 key, int feature, float distance2, float3 closest, float band,
                             float longest_push, global const float4* triangles, global const float* tools) {
  Kept out = {x, 0, 0.0f, 0};
  float phi = 0.0f;
  float3 normal = (float3)(0.0f);
  bool rim = true;
  int tool = -1;
  if (feature >= 0 && distance2 < 4.0f * band * band) {
    tool = as_int(triangles[SHELL_WORDS * (feature >> 3)].w);
    const float3 here = convert_float3(4 * (key - window_of(tools, tool))) + x;
    resolve(triangles, feature, here - closest, distance2, &phi, &normal, &rim);
  }
  const bool behind_before = (old_side & 1) == 0;
  const bool same_tool = old_side > 0 && (old_side - 1) / 2 == tool;
  if (!rim && fabs(phi) < band) {
    out.side = same_tool ? old_side : 1 + 2 * tool + (phi < 0.0f ? 1 : 0);
    const float s = (out.side & 1) == 0 ? -1.0f : 1.0f;
    const float depth = tools[TOOL_WORDS * tool + TOOL_HALF] - s * phi;
    if (depth > 0.0f) {
      out.push = fmin(depth, longest_push);
      out.x += s * out.push * normal;
      out.crossed = s * phi + out.push < 0.0f;  // still behind the plate's middle
    }
  } else if (!rim && same_tool && distance2 < 4.0f * band * band) {
    out.crossed = (phi < 0.0f) != behind_before;  // left the band on the side where it never was
  }
  return out;
}

#endif  // NAVVY_KERNELS_SOIL_SHELL_SIDE_H
