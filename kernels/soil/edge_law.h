// SPDX-License-Identifier: Apache-2.0
// Bearing resistance of soil ahead of the free edge of a plate, which is thinner than a cell
// [docs/tools.md, edges].
//
// One source for the kernels and the double-precision twin, in the dialect of kernels/README.md.
#ifndef NAVVY_KERNELS_SOIL_EDGE_LAW_H
#define NAVVY_KERNELS_SOIL_EDGE_LAW_H

#include "soil/scheme_constants.h"

// Returns a bearing factor of an edge. flat: factor of a blunt edge; wedge: factor of a smooth
// wedge with the edge's bevel; rise: friction coefficient of the wedge's faces / tangent of half
// the bevel. A blunt edge pushes a wedge of soil ahead of it, so no bevel resists more.
INLINED scalar edge_factor(scalar flat, scalar wedge, scalar rise) {
  return fmin(flat, wedge * (1.0f + rise));
}

// Returns the largest pressure of soil on an edge [Pa] [Prandtl 1920] [docs/tools.md, edges].
// cohesion: cohesion of the soil around the edge [Pa]; overburden: weight of the soil above the
// edge per area [Pa]; nc, nq: bearing factors, from edge_factor.
INLINED scalar edge_pressure(scalar cohesion, scalar overburden, scalar nc, scalar nq) {
  return cohesion * nc + overburden * nq;
}

// Returns the share of an edge's resistance that acts, 0 .. 1. ahead: speed of the plate along its
// outward direction [m/s]; speed: magnitude of the plate's velocity [m/s]; slow: speed below which
// a plate counts as standing still [m/s].
//
// A plate that advances mainly in its own plane, or stands still, has the whole resistance. One
// that moves across its plane slides its end along the soil and has almost none: its face works.
INLINED scalar edge_share(scalar ahead, scalar speed, scalar slow) {
  const scalar across = sqrt(fmax(speed * speed - ahead * ahead, 0.0f));
  return fmin(fmax((ahead + slow) / (across + slow), 0.0f), 1.0f);
}

#endif  // NAVVY_KERNELS_SOIL_EDGE_LAW_H
