// SPDX-License-Identifier: Apache-2.0
// Signed distance, normal and side of one node or particle relative to the closest feature (face,
// edge or corner) of a shell, as soil/shell_query.h finds it.
#ifndef NAVVY_KERNELS_SOIL_SHELL_SIDE_H
#define NAVVY_KERNELS_SOIL_SHELL_SIDE_H

#include "soil/shell_query.h"

// Computes signed distance and normal of a point from its closest feature. Returns false if there
// is none (feature = -1).
//
// feature: Closest.feature; away: vector from the closest point to the point; distance2: its
// squared length; phi: output, signed distance, positive in front of the plate [cells]; normal:
// output, unit normal towards the front of the plate; rim: output, true if the closest feature is
// on a free edge.
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

// Returns the velocity fields of a node: 0 one field; 1 two fields, the node is in front of the
// plate; 2 two fields, the node is behind it. rim, phi: from `resolve`; band: distance from a plate
// within which nodes are split [cells].
static inline int split_of(bool rim, float phi, float band) {
  return rim || fabs(phi) >= band ? 0 : phi >= 0.0f ? 1 : 2;
}

// Returns the position of a near node relative to the plate for the contact: normal towards the
// front, signed distance phi and inset [cells].
static inline NodeShell node_shell_of(float3 normal, float phi, float inset) {
  const NodeShell out = {{normal.x, normal.y, normal.z}, phi, inset, {0.0f, 0.0f, 0.0f}};
  return out;
}

// New state of one particle near a shell [docs/tools.md, sides].
typedef struct SideResult {
  // Position relative to the corner of the particle's block [cells].
  float3 x;
  // Side: 0 if no shell is near, else 1 + 2 * tool index, plus 1 if behind the shell.
  int side;
  // Length by which the particle was pushed out of the plate [cells].
  float push;
  // 1 if the particle is on the wrong side of the plate, else 0.
  int crossed;
} SideResult;

// Returns the new side and position of a particle of block `key` whose position is x. feature,
// distance2, closest: closest point of the shells, as in Closest; old_side: previous side of the
// particle; band: distance from a plate within which particles have a side [cells]; longest_push:
// largest push in one transfer [cells].
//
// A particle that has sunk into the plate is pushed back to the surface of the plate. A particle
// that appears to be farther behind the plate than possible (contact_max_depth) is in fact beside
// another plate of the same tool, which it faces from the other side (for example where plates meet
// in a T). It keeps its position, and its new side is that relative to the other plate.
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
