// SPDX-License-Identifier: Apache-2.0
// Arithmetic of one particle: weights, the stress and momentum that it gives to the nodes, and the
// gradient and volume that it receives from the nodes.
//
// One source for sixteen lanes, for one work-item, for the native loop and for the double-precision
// twin (kernels/README.md, one dialect). The schedules decide which work-item computes a particle,
// and in which order sums over particles and nodes run.
#ifndef NAVVY_KERNELS_SOIL_POINT_H
#define NAVVY_KERNELS_SOIL_POINT_H

#include "soil/law.h"

// Computes the quadratic B-spline weights w[0 .. 2] of the nodes base, base + 1 and base + 2 along
// one axis. f = x - base is in [0.5, 1.5).
INLINED void spline(real f, real* w) {
  const real a = 1.5f - f, b = f - 1.0f, c = f - 0.5f;
  w[0] = 0.5f * a * a;
  w[1] = 0.75f - b * b;
  w[2] = 0.5f * c * c;
}

// Returns the base node of a coordinate relative to the corner of its block [cells]. The result is
// limited to the tile even for a NaN: the host will stop the run, but the kernel must not write
// outside the tile.
INLINED real base_node(real x) { return smaller(larger(floored(x - 0.5f), -1.0f), 4.0f); }

// Returns the tile that particles on a given side (particle_fields.h) scatter to, and the node
// field that they gather from: 0 neutral, 1 front, 2 back.
INLINED ints tile_of(ints side) { return side > 0 ? 2 - (side & 1) : 0; }

// Returns the mean opening J / J0 of a cell, or 0 if no particle of the cell is open (J > J0).
// volume, bank: sums of mass x J and mass x J0 over the cell [mass quanta]; open: number of open
// particles.
//
// Opening is a property of the cell and not of one particle [docs/soil.md, mixing]. If half of the
// particles of a cell were open and half closed, the closed ones would carry a heap by themselves,
// and it would come to rest too loose.
INLINED real mean_opening(real volume, real bank, real open) {
  return open > 0.0f ? volume / larger(bank, 1.0f) : 0.0f;
}

// Returns J of a particle after it has relaxed by the share `mixing` towards the mean opening of
// its cell. An opening of 0 leaves J unchanged.
INLINED real mixed(real j, real j0, real opening, real mixing) {
  return opening > 0.0f ? j + mixing * (j0 * opening - j) : j;
}

// Returns the shear strain rate sqrt(2 D:D) of D = (C + C^T) / 2 [1/s]. c: velocity gradient C, row
// by row.
INLINED real strain_rate(const real* c) {
  const real xy = c[1] + c[3], xz = c[2] + c[6], yz = c[5] + c[7];
  return sqrt(2.0f * (c[0] * c[0] + c[4] * c[4] + c[8] * c[8]) + (xy * xy + xz * xz + yz * yz));
}

// Advances one particle over one step of dt [s]: mixes its J, then applies the soil law. sigma:
// output of law_update. If J is not finite before the step it becomes a NaN, because the limits in
// the law would hide it.
//
// opening: from mean_opening. mixing: dt / mixing strain [s], which gives a share when multiplied
// by the strain rate. most_mixing: largest share in a step [-]. Mixing is proportional to strain,
// so that the soil at a slow tool, or soil at rest under stress, is not mixed more than other soil.
INLINED void advance_state(const real* c, scalar dt, const LawSoil* soil, real opening,
                           scalar mixing, scalar most_mixing, LawState* state, real* sigma) {
  const real before = state->j;
  state->j = mixed(before, state->j0, opening, smaller(mixing * strain_rate(c), most_mixing));
  law_update(c, dt, soil, state, sigma);
  state->j = isfinite(before) ? state->j : before + NAN;
}

// Computes the momentum that a particle gives to the nodes: `start` at its base node, and the
// change a[3 * i + j] of component i per node along axis j [kg m/s].
//
// A = m C dx - dt 4/dx V sigma is the sum of the affine part [Jiang 2015] and of the impulse of the
// stress, as in MLS-MPM [Hu 2018]. bank: mass / bank density [m3]; f: offset from the base node
// [cells]; dx: edge of a cell [m]. carried: 1 in the first step of a transfer; 0 in later steps, in
// which the nodes still have their momentum and only the stress adds to it.
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

// Returns one component of the velocity gradient C = 4/dx^2 sum w v (x_i - x_p)^T [1/s]. v: a
// component of the gathered velocity [m/s]; moment: first moment of that component about the base
// node along one axis [m/s x cells]; f: offset from the base node along that axis [cells].
INLINED real velocity_gradient(real moment, real f, real v, scalar dx) {
  return (4.0f / dx) * (moment - f * v);
}

// Returns the share of the separating displacement that a particle makes in this step: above 0
// where soil is crowded, else 0. J is integrated over time and cannot detect particles that crowd;
// the nodes can [docs/soil.md, crowding].
//
// Soil is crowded where the nodes contain more mass than both J and the density state allow. Opened
// soil in flight (J > J0) is not. The share is proportional to the shear rate and not to time, so
// soil at rest keeps its positions. full: node mass, divided by the free fraction, above which soil
// counts as crowded at J = 1 [kg]. spread: dt / shear strain over which crowded soil separates [s].
INLINED real crowding(const real* c, real j, real j0, real node_mass, scalar full, scalar spread) {
  const real packed = full / larger(node_mass, MASS_QUANTUM);
  return smaller(j, j0) > packed ? smaller(spread * strain_rate(c), 1.0f) : 0.0f;
}

// Returns the corrected J of a particle that is open (J > J0) although its nodes contain the mass
// of closed soil; otherwise returns j. Numerical noise of the flow opens closed soil, which would
// cost the soil its cohesion. The correction removes a share of the distance to the density state.
// Open soil carries no pressure, so the correction neither costs nor supplies energy
// [docs/soil.md, opening]. filled: node mass, divided by the free fraction, that counts as closed
// at J = 1 [kg].
INLINED real close_noise(real j, real j0, real node_mass, scalar filled, scalar share) {
  const real closing = j + share * (j0 - j);
  return j > j0 && j < SCHEME(max_closing_ratio) * j0 && node_mass * j0 >= filled ? closing : j;
}

// Returns the separating displacement of a particle along one axis [cells], away from where the
// nodes contain more mass. share: from `crowding`; lean: sum of node mass x node position relative
// to the particle along the axis [kg cells]; most: largest displacement [cells].
INLINED real crowding_displacement(real share, real lean, real node_mass, scalar most) {
  return smaller(larger(-share * lean / larger(node_mass, MASS_QUANTUM), -most), most);
}

// Returns the largest absolute component of the velocity v; infinite if a component is not finite.
INLINED real fastest_component(const real* v) {
  const real largest = larger(larger(fabs(v[0]), fabs(v[1])), fabs(v[2]));
  return isfinite(v[0] + v[1] + v[2]) ? largest : INFINITY;
}

#endif  // NAVVY_KERNELS_SOIL_POINT_H
