// SPDX-License-Identifier: Apache-2.0
// Arithmetic of one particle: weights, stress and momentum given to the nodes, and the gradient and
// volume that follow from the nodes. One source for sixteen lanes, for one work-item, for the
// native loop and for the double twin (kernels/README.md, one dialect). The schedules decide which
// work-item computes it, and in which order sums over particles and nodes run.
#ifndef NAVVY_KERNELS_SOIL_POINT_H
#define NAVVY_KERNELS_SOIL_POINT_H

#include "soil/law.h"

// Computes the quadratic B-spline weights of the nodes base, base + 1, base + 2, where f = x - base
// lies in [0.5, 1.5).
INLINED void spline(real f, real* w) {
  const real a = 1.5f - f, b = f - 1.0f, c = f - 0.5f;
  w[0] = 0.5f * a * a;
  w[1] = 0.75f - b * b;
  w[2] = 0.5f * c * c;
}

// Returns the base node of a coordinate from the corner of its block. It stays inside the tile even
// for a NaN: the host stops the run, but the kernel must not write elsewhere.
INLINED real base_node(real x) { return fmin(fmax(floor(x - 0.5f), -1.0f), 4.0f); }

// Returns the tile, and node field, of a particle's side (0 none, 1 + 2 tool + behind): 0 neutral,
// 1 front, 2 back.
INLINED ints tile_of(ints side) { return side > 0 ? 2 - (side & 1) : 0; }

// Returns the mean opening J / J0 of a cell from its sums of volume and of volume in the density
// state [mass quanta]. open: above 0 if any particle of the cell is open; otherwise the mean is 0.
//
// Opening is a property of the cell, not of one particle [docs/soil.md, mixing]. If half the
// particles of a cell are open and half closed, the closed ones alone would carry a heap and it
// would rest too loose.
INLINED real mean_opening(real volume, real bank, real open) {
  return open > 0.0f ? volume / fmax(bank, 1.0f) : 0.0f;
}

// Returns J of a particle that relaxes by the share `mixing` towards the opening of its cell. An
// opening of 0 leaves it unchanged.
INLINED real mixed(real j, real j0, real opening, real mixing) {
  return opening > 0.0f ? j + mixing * (j0 * opening - j) : j;
}

// Returns sqrt(2 D:D) of D = (C + C^T) / 2 [1/s].
INLINED real strain_rate(const real* c) {
  const real xy = c[1] + c[3], xz = c[2] + c[6], yz = c[5] + c[7];
  return sqrt(2.0f * (c[0] * c[0] + c[4] * c[4] + c[8] * c[8]) + (xy * xy + xz * xz + yz * yz));
}

// Mixes and advances one particle over one step. A J that is not finite becomes a NaN, which the
// limits of the law would hide.
//
// mixing: dt / mixing strain [s], a share when multiplied by the strain rate. most_mixing: largest
// share in a step [-]. Mixing follows strain, so that the soil of a slow tool, or soil at rest
// under stress, is not mixed longer.
INLINED void advance_state(const real* c, scalar dt, const LawSoil* soil, real opening,
                           scalar mixing, scalar most_mixing, LawState* state, real* sigma) {
  const real before = state->j;
  state->j = mixed(before, state->j0, opening, fmin(mixing * strain_rate(c), most_mixing));
  law_update(c, dt, soil, state, sigma);
  state->j = isfinite(before) ? state->j : before + NAN;
}

// Computes the momentum that a particle gives to the nodes: `start` at its base node, and its
// change per node step, a[3 * i + j] of component i along axis j [kg m/s].
//
// A = m C dx - dt 4/dx V sigma: the affine part [Jiang 2015] and the stress as in MLS-MPM
// [Hu 2018]. bank = mass / bank density [m3], f = offset from the base node [cells]. In a held step
// the nodes still have their momentum: `carried` is 0 and only the stress adds to it; otherwise it
// is 1.
INLINED void affine_momentum(const real* c, const real* sigma, const real* v, const real* f,
                             real mass, real bank, real j, scalar carried, scalar dt, scalar dx,
                             real* start, real* a) {
  const real carried_mass = carried * mass, cm = carried_mass * dx,
             sv = (4.0f * dt / dx) * bank * j;
  a[0] = cm * c[0] - sv * sigma[0];
  a[1] = cm * c[1] - sv * sigma[3];
  a[2] = cm * c[2] - sv * sigma[5];
  a[3] = cm * c[3] - sv * sigma[3];
  a[4] = cm * c[4] - sv * sigma[1];
  a[5] = cm * c[5] - sv * sigma[4];
  a[6] = cm * c[6] - sv * sigma[5];
  a[7] = cm * c[7] - sv * sigma[4];
  a[8] = cm * c[8] - sv * sigma[2];
  start[0] = carried_mass * v[0] - (a[0] * f[0] + a[1] * f[1] + a[2] * f[2]);
  start[1] = carried_mass * v[1] - (a[3] * f[0] + a[4] * f[1] + a[5] * f[2]);
  start[2] = carried_mass * v[2] - (a[6] * f[0] + a[7] * f[1] + a[8] * f[2]);
}

// Returns a component of C = 4/dx^2 sum w v (x_i - x_p)^T [1/s] from a component of the gathered
// velocity v, its first moment about the base node along one axis [m/s x cells], and the offset f
// along that axis.
INLINED real velocity_gradient(real moment, real f, real v, scalar dx) {
  return (4.0f / dx) * (moment - f * v);
}

// Returns the share of the separating displacement that a particle makes where soil is crowded, 0
// elsewhere. J is integrated and cannot see particles crowd; the nodes can
// [docs/soil.md, crowding].
//
// Soil is crowded where the nodes hold more mass than both J and the density state give. Opened
// soil in flight (J > J0) is not. The share follows the shear rate, not time: soil at rest keeps
// its positions. full: mass of a node at J = 1 that means packed [kg]. spread: dt / shear strain
// that separates crowded soil [s].
INLINED real crowding(const real* c, real j, real j0, real node_mass, scalar full, scalar spread) {
  const real packed = full / fmax(node_mass, MASS_QUANTUM);
  return fmin(j, j0) > packed ? fmin(spread * strain_rate(c), 1.0f) : 0.0f;
}

// Returns J of a particle that is open while its nodes hold the mass of closed soil. Numerical
// noise of the flow opens soil that is closed, which would cost its cohesion. It closes by a share
// of the distance to the density state. Soil carries no pressure there, so closing costs and gives
// no energy [docs/soil.md, opening]. filled: mass of a node that counts as closed at J = 1 [kg].
INLINED real close_noise(real j, real j0, real node_mass, scalar filled, scalar share) {
  const real closing = j + share * (j0 - j);
  return j > j0 && j < SCHEME(max_closing_ratio) * j0 && node_mass * j0 >= filled ? closing : j;
}

// Returns the separating displacement along an axis [cells], away from where the nodes hold more
// mass. lean: node masses x their positions along the axis, relative to the particle [kg cells];
// most: largest displacement [cells].
INLINED real crowding_displacement(real share, real lean, real node_mass, scalar most) {
  return fmin(fmax(-share * lean / fmax(node_mass, MASS_QUANTUM), -most), most);
}

// Returns the largest component of a velocity, infinite when one is not finite.
INLINED real fastest_component(const real* v) {
  const real largest = fmax(fmax(fabs(v[0]), fabs(v[1])), fabs(v[2]));
  return isfinite(v[0] + v[1] + v[2]) ? largest : INFINITY;
}

#endif  // NAVVY_KERNELS_SOIL_POINT_H
