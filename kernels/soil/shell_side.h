// SPDX-License-Identifier: Apache-2.0
// What one node or particle learns from the closest feature of a shell (soil/shell_query.h): signed
// distance, normal, side.
#ifndef NAVVY_KERNELS_SOIL_SHELL_SIDE_H
#define NAVVY_KERNELS_SOIL_SHELL_SIDE_H

#include "soil/shell_query.h"

// What one point learns from its closest feature. The normal points away from the plate in front,
// to it behind: to the front either way.
static inline bool resolve(global const ShellTriangle* triangles, int feature, float3 away, float distance2, float* phi,
                           float3* normal, bool* rim) {
  if (feature < 0) return false;
  global const ShellTriangle* triangle = triangles + (feature >> 3);
  global const ShellFeature* closest = triangle->feature + (feature & 7);
  const float d = sqrt(distance2);
  const float sign = dot(away, vload3(0, closest->normal)) >= 0.0f ? 1.0f : -1.0f;
  *phi = sign * d;
  // On the plate itself the direction is the plate's.
  *normal = d > 1e-4f ? away * (sign / d) : vload3(0, triangle->feature[0].normal);
  *rim = closest->free > 0.0f;
  return true;
}

// Which field of velocities a node has: 0 one, 1 split and in front, 2 split and behind.
static inline int split_of(bool rim, float phi, float band) {
  return rim || fabs(phi) >= band ? 0 : phi >= 0.0f ? 1 : 2;
}

static inline NodeShell node_shell_of(float3 normal, float phi, float inset) {
  const NodeShell out = {{normal.x, normal.y, normal.z}, phi, inset, {0.0f, 0.0f, 0.0f}};
  return out;
}

// One particle near a shell. side = 1 + 2 tool + behind, 0: none [docs/tools.md, sides].
typedef struct SideResult {
  float3 x;  // position [cells from its block's corner]
  int side;
  float push;  // out of the plate [cells]
  int crossed;
} SideResult;

// How far behind a plate a particle can be that has not been counted as a crossing [cells]: a
// transfer's way of its own and of the tool, 0.2 each, after a push that left as much; a tenth for
// rounding.
#define FARTHEST_BEHIND 0.7f

// The side of a particle of block `key` whose closest feature is `feature` at `closest`; a particle
// that sank into the plate comes back to its surface. One that seems farther behind than it can be
// came to another plate of the tool, which shows it its other face (plates that meet in a T), and
// lies where it lies.
static inline SideResult enforce_side(float3 x, int old_side, int3 key, int feature, float distance2, float3 closest,
                                   float band, float longest_push, global const ShellTriangle* triangles,
                                   global const Tool* tools) {
  SideResult out = {x, 0, 0.0f, 0};
  float phi = 0.0f;
  float3 normal = (float3)(0.0f);
  bool rim = true;
  int tool = -1;
  if (feature >= 0 && distance2 < 4.0f * band * band) {
    tool = triangles[feature >> 3].tool;
    const float3 here = convert_float3(4 * (key - window_of(tools, tool))) + x;
    resolve(triangles, feature, here - closest, distance2, &phi, &normal, &rim);
  }
  const bool behind_before = (old_side & 1) == 0;
  const bool same_tool = old_side > 0 && (old_side - 1) / 2 == tool;
  if (!rim && fabs(phi) < band) {
    const bool other_plate = (phi < 0.0f) != behind_before && fabs(phi) > FARTHEST_BEHIND;
    out.side = same_tool && !other_plate ? old_side : 1 + 2 * tool + (phi < 0.0f ? 1 : 0);
    const float s = (out.side & 1) == 0 ? -1.0f : 1.0f;
    const float depth = tools[tool].half_thickness - s * phi;
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
