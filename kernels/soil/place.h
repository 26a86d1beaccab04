// SPDX-License-Identifier: Apache-2.0
// Destinations of particles in a re-bin: the neighbours of a block, the block that a particle has
// drifted into, and the contact properties of its soil. One source for both schedules, included
// after the header of their dialect.
#ifndef NAVVY_KERNELS_SOIL_PLACE_H
#define NAVVY_KERNELS_SOIL_PLACE_H

#include "soil/layout.h"

// Returns the offset of neighbour n, 0 .. 26, from a block: x varies fastest, each coordinate is
// -1, 0 or 1, and n = 13 is the block itself.
static inline int3 neighbour_offset(int n) { return (int3)(n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1); }

// Destination codes of a particle: 0 .. 26 is the neighbour of its block that it moves into,
// LEFT_SITE means that it is outside the site. CODES is the number of codes.
#define LEFT_SITE 27
#define CODES 28
// Code of a particle that is removed; it is not counted.
#define REMOVED 255
// Number of old blocks from which a new block takes particles: its 27 neighbours, and last a block
// of added particles, whose code is that of the block itself, 13.
#define SOURCES 28
#define ADDED_SOURCE 27

// Destination of one particle.
typedef struct Place {
  // Destination code, 0 .. LEFT_SITE.
  uchar code;
  // Cell of the particle's base node within the new block, 0 .. 63, x fastest.
  uchar cell;
} Place;

// Returns the destination of a particle at (x, y, z), relative to the corner of its current block
// [cells]. site: x and y of the site's lower-left corner, then of its upper-right corner, relative
// to the same corner.
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

// Returns the site's corners relative to the corner of block `key` [cells]. site: x and y of the
// lower-left, then of the upper-right corner in G.
static inline float4 site_from(int4 site, int4 key) {
  const float bx = 4.0f * key.x, by = 4.0f * key.y;
  return (float4)(site.x - bx, site.y - by, site.z - bx, site.w - by);
}

// Returns the destination code of the particles that a new block takes from source i, and the order
// of arrival with it. Re-bins take the neighbours in the order of the codes; with `ascending` they
// come in the order of their keys, as in ParticleStore::sorted: the key of a source falls as its
// code rises.
static inline int code_of_source(int i, int ascending) {
  return i == ADDED_SOURCE ? 13 : ascending ? 26 - i : i;
}

// Cases of rest_of, for the lists of particle_fields.h.
#define REST_ONE(NAME, member, rest) \
  if (f <= FIELD_##NAME) return rest;
#define REST_MANY(NAME, member, count, rest) \
  if (f <= FIELD_##NAME##_LAST) return rest;
// Returns the value of field f in an unused lane.
static inline float rest_of(int f) {
  FLOAT_FIELDS(REST_ONE, REST_MANY)
  return 0.0f;
}

// Returns the contact properties of a soil as the float4 form of ContactSoil.
static inline float4 surface_of(constant SoilRow* soil) {
  return (float4)(soil->tool_friction, soil->adhesion, soil->inv_density, 0.0f);
}

#endif  // NAVVY_KERNELS_SOIL_PLACE_H
