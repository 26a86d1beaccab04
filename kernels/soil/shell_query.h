// SPDX-License-Identifier: Apache-2.0
// Closest point on the triangles of shells, for several points at a time: one `real` holds a
// coordinate of all points that a work-item computes (soil/lanes/lanes.h or soil/groups/group.h).
//
// Lengths are in cells from the window corner of the triangle's tool (tool.h). The sign of a
// distance comes from the pseudo-normal of the closest face, edge or corner [Baerentzen 2005],
// which is correct at convex and concave folds. With plain face normals, a point in front of an
// inner corner would count as behind one of the faces.
#ifndef NAVVY_KERNELS_SOIL_SHELL_QUERY_H
#define NAVVY_KERNELS_SOIL_SHELL_QUERY_H

#include "soil/tool.h"

// Closest point of the triangles examined so far, for each point.
typedef struct Closest {
  // Squared distance [cells^2]; infinite if no triangle was close enough.
  real distance2;
  // Closest point, relative to the window corner of its tool [cells].
  real x, y, z;
  // 8 * triangle index + feature index (0 face, 1 .. 3 edges, 4 .. 6 corners); -1 if no triangle
  // was close enough.
  ints feature;
} Closest;

// Updates `best` with the edge from a to a + ab. p: the points; all coordinates are relative to the
// same corner [cells]. `feature`: value of Closest.feature for a closest point inside the edge;
// `corner_a`, `corner_b`: values for its two ends.
static inline void closest_edge(real px, real py, real pz, float3 a, float3 ab, int feature,
                                int corner_a, int corner_b, Closest* best) {
  const float inv = 1.0f / dot(ab, ab);
  const real t =
      fmin(fmax(((px - a.x) * ab.x + (py - a.y) * ab.y + (pz - a.z) * ab.z) * inv, 0.0f), 1.0f);
  const real cx = a.x + t * ab.x, cy = a.y + t * ab.y, cz = a.z + t * ab.z;
  const real dx = px - cx, dy = py - cy, dz = pz - cz;
  const real d2 = dx * dx + dy * dy + dz * dz;
  const ints which =
      select(select((ints)(feature), (ints)(corner_b), t >= 1.0f), (ints)(corner_a), t <= 0.0f);
  // Of equal distances the first is kept, so the result depends on the order of the candidates,
  // which is ascending.
  const ints nearer = d2 < best->distance2;
  best->distance2 = select(best->distance2, d2, nearer);
  best->x = select(best->x, cx, nearer);
  best->y = select(best->y, cy, nearer);
  best->z = select(best->z, cz, nearer);
  best->feature = select(best->feature, which, nearer);
}

// Updates `best` with triangle t for the points p (relative to the window corner of the triangle's
// tool) [cells]. Skips the triangle if all points are farther than `far` from its plane, or farther
// than `far` plus its radius from its centre.
static inline void closest_triangle(real px, real py, real pz,
                                    global const ShellTriangle* triangles, int t, float far,
                                    Closest* best) {
  global const ShellTriangle* triangle = triangles + t;
  const float3 a = vload3(0, triangle->a), b = vload3(0, triangle->b), c = vload3(0, triangle->c);
  const float3 n = vload3(0, triangle->feature[0].normal);
  const real height = (px - a.x) * n.x + (py - a.y) * n.y + (pz - a.z) * n.z;
  if (!some(fabs(height) < far)) return;
  const float3 centre = (a + b + c) * (1.0f / 3.0f);
  const float reach = far + triangle->radius;
  const real ox = px - centre.x, oy = py - centre.y, oz = pz - centre.z;
  if (!some(ox * ox + oy * oy + oz * oz < reach * reach)) return;
  // A point whose foot is inside the triangle is closest to the face; else to an edge or corner.
  const float3 ma = cross(n, b - a), mb = cross(n, c - b), mc = cross(n, a - c);
  const ints inside = ((px - a.x) * ma.x + (py - a.y) * ma.y + (pz - a.z) * ma.z >= 0.0f) &
                      ((px - b.x) * mb.x + (py - b.y) * mb.y + (pz - b.z) * mb.z >= 0.0f) &
                      ((px - c.x) * mc.x + (py - c.y) * mc.y + (pz - c.z) * mc.z >= 0.0f);
  const ints nearer = inside & (height * height < best->distance2);
  best->distance2 = select(best->distance2, height * height, nearer);
  best->x = select(best->x, px - height * n.x, nearer);
  best->y = select(best->y, py - height * n.y, nearer);
  best->z = select(best->z, pz - height * n.z, nearer);
  best->feature = select(best->feature, (ints)(8 * t), nearer);
  closest_edge(px, py, pz, a, b - a, 8 * t + 1, 8 * t + 4, 8 * t + 5, best);
  closest_edge(px, py, pz, b, c - b, 8 * t + 2, 8 * t + 5, 8 * t + 6, best);
  closest_edge(px, py, pz, c, a - c, 8 * t + 3, 8 * t + 6, 8 * t + 4, best);
}

// Returns the squared distance of the points p to the segment from a to a + ab [cells^2].
static inline real segment_distance2(real px, real py, real pz, float3 a, float3 ab) {
  const float inv = 1.0f / dot(ab, ab);
  const real t =
      fmin(fmax(((px - a.x) * ab.x + (py - a.y) * ab.y + (pz - a.z) * ab.z) * inv, 0.0f), 1.0f);
  const real dx = px - a.x - t * ab.x, dy = py - a.y - t * ab.y, dz = pz - a.z - t * ab.z;
  return dx * dx + dy * dy + dz * dz;
}

// Returns the squared distance of the points p to the nearest free edge of their tool [cells^2];
// infinite if the tool has no free edge. tool: index of the tool of each point; count: number of
// `rims`.
static inline real inset2_of(real px, real py, real pz, ints tool, global const ShellRim* rims,
                             int count) {
  // A tool without free edges, such as a closed body, has an infinite inset.
  real inset2 = INFINITY;
  for (int r = 0; r < count; ++r) {
    const real e2 =
        segment_distance2(px, py, pz, vload3(0, rims[r].start), vload3(0, rims[r].along));
    inset2 = select(inset2, fmin(inset2, e2), tool == (ints)(rims[r].tool));
  }
  return inset2;
}

// Returns the block whose lower corner is the origin of the tool's coordinates.
static inline int3 window_of(global const Tool* tools, int tool) {
  return vload3(0, tools[tool].window);
}

// Finds the closest of the triangles list[begin] .. list[end - 1] to the points (x, y, z), which
// are relative to the lower corner of block `key` [cells], and stores it in `best`. Triangles
// farther than `far` [cells] may be skipped.
static inline void query(real x, real y, real z, int3 key, global const ShellTriangle* triangles,
                         global const Tool* tools, global const int* list, int begin, int end,
                         float far, Closest* best) {
  best->distance2 = INFINITY;
  best->x = best->y = best->z = 0.0f;
  best->feature = -1;
  for (int i = begin; i < end; ++i) {
    // Triangles of different tools have different window corners; the points follow.
    const float3 shift = convert_float3(4 * (key - window_of(tools, triangles[list[i]].tool)));
    closest_triangle(x + shift.x, y + shift.y, z + shift.z, triangles, list[i], far, best);
  }
}

#endif  // NAVVY_KERNELS_SOIL_SHELL_QUERY_H
