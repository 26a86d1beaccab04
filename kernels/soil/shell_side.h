// SPDX-License-Identifier: Apache-2.0
// Signed distance, normal and side of one node or particle from the closest feature of a shell
// (soil/shell_query.h).
#ifndef NAVVY_KERNELS_SOIL_SHELL_SIDE_H
#define NAVVY_KERNELS_SOIL_SHELL_SIDE_H

#include "soil/shell_query.h"

// Finds the signed distance phi [cells] and the normal of one point from its closest feature. The
// normal always points to the front of the plate. Returns false without a feature.
static inline bool resolve(global const ShellTriangle* triangles, int feature, float3 away,
                           float distance2, float* phi, float3* normal, bool* rim) {
  if (feature < 0) return false;
  global const ShellTriangle* triangle = triangles + (feature >> 3);
  global const ShellFeature* closest = triangle->feature + (feature & 7);
  const float d = sqrt(distance2);
  const float sign = dot(away, vload3(0, closest->normal)) >= 0.0f ? 1.0f : -1.0f;
  *phi = sign * d;
  // On the plate itself the normal is that of the plate.
  *normal = d > 1e-4f ? away * (sign / d) : vload3(0, triangle->feature[0].normal);
  *rim = closest->free > 0.0f;
  return true;
}

// Returns the velocity field that a node belongs to: 0 unsplit, 1 split and in front, 2 split and
// behind.
static inline int split_of(bool rim, float phi, float band) {
  return rim || fabs(phi) >= band ? 0 : phi >= 0.0f ? 1 : 2;
}

// Returns the data of a near node for the contact: normal to the front, signed distance and inset
// [cells].
static inline NodeShell node_shell_of(float3 normal, float phi, float inset) {
  const NodeShell out = {{normal.x, normal.y, normal.z}, phi, inset, {0.0f, 0.0f, 0.0f}};
  return out;
}

// New state of one particle near a shell. side = 1 + 2 tool + behind, 0: none
// [docs/tools.md, sides].
typedef struct SideResult {
  // Position [cells from the corner of its block].
  float3 x;
  int side;
  // Push out of the plate [cells].
  float push;
  int crossed;
} SideResult;

// Returns the side of a particle of block `key` whose closest feature is `feature` at `closest`. A
// particle that has sunk into the plate returns to its surface. A particle that seems farther
// behind than possible (contact_max_depth) has come to another plate of the tool, which shows its
// other face to it (plates that meet in a T). It keeps its position.
static inline SideResult enforce_side(float3 x, int old_side, int3 key, int feature,
                                      float distance2, float3 closest, float band,
                                      float longest_push, global const ShellTriangle* triangles,
                                      global const Tool* tools) {
  SideResult out = {x, 0, 0.0f, 0};
  float phi = 0.0f;
  float3 normal = (float3)(0.0f);
  bool rim = true;
  int tool = -1;
  if (feature >= 0 && distance2 < 4.0f * band * band) {
    tool = triangles[feature >> 3].tool;
    // From the block's corner to the window corner of the tool, as the closest point.
    const float3 here = convert_float3(4 * (key - window_of(tools, tool))) + x;
    resolve(triangles, feature, here - closest, distance2, &phi, &normal, &rim);
  }
  const bool behind_before = (old_side & 1) == 0;
  const bool same_tool = old_side > 0 && (old_side - 1) / 2 == tool;
  if (!rim && fabs(phi) < band) {
    const bool other_plate = (phi < 0.0f) != behind_before && fabs(phi) > SCHEME(contact_max_depth);
    // Inside the band a particle keeps the side that it had; a particle that has just entered gets
    // the side of its sign.
    out.side = same_tool && !other_plate ? old_side : 1 + 2 * tool + (phi < 0.0f ? 1 : 0);
    const float s = (out.side & 1) == 0 ? -1.0f : 1.0f;
    const float depth = tools[tool].half_thickness - s * phi;
    if (depth > 0.0f) {
      // A limited push: soil that a fast plate has overrun returns within some transfers, without a
      // jump.
      out.push = fmin(depth, longest_push);
      out.x += s * out.push * normal;
      // Still behind the middle of the plate.
      out.crossed = s * phi + out.push < 0.0f;
    }
  } else if (!rim && same_tool && distance2 < 4.0f * band * band) {
    // The particle left the band on a side where it never was.
    out.crossed = (phi < 0.0f) != behind_before;
  }
  return out;
}

#endif  // NAVVY_KERNELS_SOIL_SHELL_SIDE_H
