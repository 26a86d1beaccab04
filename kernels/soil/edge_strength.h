// SPDX-License-Identifier: Apache-2.0
// Strength of the soil around edges of plates: sums over particles, for several at a time. One
// source for both schedules.
#ifndef NAVVY_KERNELS_SOIL_EDGE_STRENGTH_H
#define NAVVY_KERNELS_SOIL_EDGE_STRENGTH_H

#include "soil/law.h"

// Weighted sums over particles: mass, mass x cohesion [Pa], mass x sin phi.
typedef struct EdgeSums {
  real mass, cohesion, sin_phi;
} EdgeSums;

// Returns the weights of particles at (x, y, z) in the strength of the soil around the edge points
// begin .. end - 1: 1 at a point, 0 beyond the scheme's edge_around. Lengths are in cells.
INLINED real edge_weight(real x, real y, real z, global const float4* points, int begin, int end) {
  const float far2 = SCHEME(edge_around) * SCHEME(edge_around);
  real nearest2 = far2;
  for (int p = begin; p < end; ++p) {
    const real dx = x - points[p].x, dy = y - points[p].y, dz = z - points[p].z;
    nearest2 = fmin(nearest2, dx * dx + dy * dy + dz * dz);
  }
  return 1.0f - nearest2 * (1.0f / far2);
}

// Adds particles of one soil to the sums. mass: weighted masses; j, j0, shear: as in LawState.
INLINED void add_strength(EdgeSums* sums, constant const SoilRow* row, real mass, real j, real j0,
                          real shear) {
  LawSoil soil;
#define LAW_CONSTANT(name) soil.name = row->name;
  LAW_CONSTANTS(LAW_CONSTANT)
#undef LAW_CONSTANT
  soil.k_bond *= SCHEME(edge_bond);
  const float inv_cos = 1.0f / sqrt(1.0f - row->alpha * row->alpha);
  const real cohesion = inv_cos * cohesion_term(&soil, dense_share(&soil, j0), shear) *
                        opening_share(&soil, j / j0 - 1.0f);
  sums->mass += mass;
  sums->cohesion += mass * cohesion;
  sums->sin_phi += mass * row->alpha;
}

#endif  // NAVVY_KERNELS_SOIL_EDGE_STRENGTH_H
