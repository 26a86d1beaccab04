// SPDX-License-Identifier: Apache-2.0
// Destination of stored particles: neighbours of a block, the block that a particle drifted into,
// and what its particles mean to tools. One source for both schedules, included after their
// dialect.
#ifndef NAVVY_KERNELS_SOIL_PLACE_H
#define NAVVY_KERNELS_SOIL_PLACE_H

#include "soil/layout.h"

// Returns the offset of neighbour n of 27, x fastest, each axis -1, 0, 1.
static inline int3 neighbour_offset(int n) { return (int3)(n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1); }

// Codes 0..26: into that neighbour; 27: off the site.
#define LEFT_SITE 27
#define CODES 28

typedef struct Place {
  uchar code;
  // Cell of its base node in the new block, 0..63, x fastest.
  uchar cell;
} Place;

// Returns the destination of a particle at (x, y, z) [cells from the corner of its block]. site: x
// and y of the lower left and of the upper right corner of the site, in the same frame.
static inline Place place_of(float x, float y, float z, float4 site) {
  const int3 base = convert_int3_rtn((float3)(x, y, z) - 0.5f);
  // Between two re-bins a particle drifts by less than a block, so one step to a neighbour is
  // enough.
  const int3 d = select(select((int3)(0), (int3)(1), base > 3), (int3)(-1), base < 0);
  const bool outside = x < site.x || x >= site.z || y < site.y || y >= site.w;
  const int3 cell_in_block = clamp(base - 4 * d, 0, 3);
  const Place place = {(uchar)(outside ? LEFT_SITE : (d.x + 1) + 3 * (d.y + 1) + 9 * (d.z + 1)),
                       (uchar)(cell_in_block.x + 4 * cell_in_block.y + 16 * cell_in_block.z)};
  return place;
}

// Returns the site [cells of G] relative to the corner of block `key`.
static inline float4 site_from(int4 site, int4 key) {
  const float bx = 4.0f * key.x, by = 4.0f * key.y;
  return (float4)(site.x - bx, site.y - by, site.z - bx, site.w - by);
}

// Returns the value of field f in a lane without a particle.
#define REST_ONE(NAME, member, rest) \
  if (f <= FIELD_##NAME) return rest;
#define REST_MANY(NAME, member, count, rest) \
  if (f <= FIELD_##NAME##_LAST) return rest;
static inline float rest_of(int f) {
  FLOAT_FIELDS(REST_ONE, REST_MANY)
  return 0.0f;
}

// Returns the ContactSoil of a soil; all words of it are averaged alike.
static inline float4 surface_of(constant SoilRow* soil) {
  return (float4)(soil->tool_friction, soil->adhesion, soil->inv_density, 0.0f);
}

#endif  // NAVVY_KERNELS_SOIL_PLACE_H
