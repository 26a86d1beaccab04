// SPDX-License-Identifier: Apache-2.0
// The arithmetic of one particle: weights, stress and momentum on its way to the nodes, gradient
// and volume on its way back. One source for sixteen lanes, for one work-item, for the native loop
// and for the double twin (kernels/README.md, one dialect); the schedules say who computes it when,
// and how sums over particles and nodes run.
#ifndef NAVVY_KERNELS_SOIL_POINT_H
#define NAVVY_KERNELS_SOIL_POINT_H

#include "soil/law.h"

// Quadratic B-spline over the nodes base, base + 1, base + 2 where f = x - base in [0.5, 1.5).
INLINED void spline(real f, real* w) {
  const real a = 1.5f - f, b = f - 1.0f, c = f - 0.5f;
  w[0] = 0.5f * a * a;
  w[1] = 0.75f - b * b;
  w[2] = 0.5f * c * c;
}

// Base node of a coordinate from its home's corner, kept inside the tile even for a NaN (the host
// stops the run, the kernel must not stray).
INLINED real base_node(real x) { return fmin(fmax(floor(x - 0.5f), -1.0f), 4.0f); }

// Tile, and field of nodes, of a particle's side (0 none, 1 + 2 tool + behind): 0 neutral, 1 front,
// 2 back.
INLINED ints tile_of(ints side) { return side > 0 ? 2 - (side & 1) : 0; }

// Mean opening J / J0 of a cell from its sums of volume and of volume in the density state
// [mass quanta]; 0 where `open`, a number above 0 as soon as one of its particles is open, is not.
//
// Opening of soil is a matter of the cell, not of one particle [docs/soil.md, mixing]. Where half
// the particles of a cell are open and half closed, the closed ones would carry the heap on and it
// would rest too loose.
INLINED real mean_opening(real volume, real bank, real open) { return open > 0.0f ? volume / fmax(bank, 1.0f) : 0.0f; }

// J of a particle that relaxes by the share `mixing` towards its cell's opening; as it is where the
// opening is 0.
INLINED real mixed(real j, real j0, real opening, real mixing) {
  return opening > 0.0f ? j + mixing * (j0 * opening - j) : j;
}

// sqrt(2 D:D) of D = (C + C^T) / 2 [1/s].
INLINED real strain_rate(const real* c) {
  const real xy = c[1] + c[3], xz = c[2] + c[6], yz = c[5] + c[7];
  return sqrt(2.0f * (c[0] * c[0] + c[4] * c[4] + c[8] * c[8]) + (xy * xy + xz * xz + yz * yz));
}

// Mixing and law of one step. A J that is not finite comes out as a NaN: the law's floor would hide
// it. Mixing goes by strain, so that neither a slow tool's soil nor soil that rests under stress is
// evened out for longer. mixing: dt over the strain that mixes [s], so that times the strain rate
// it is a share; most_mixing: largest share a step [-].
INLINED void advance_state(const real* c, scalar dt, const LawSoil* soil, real opening, scalar mixing,
                           scalar most_mixing, LawState* state, real* sigma) {
  const real before = state->j;
  state->j = mixed(before, state->j0, opening, fmin(mixing * strain_rate(c), most_mixing));
  law_update(c, dt, soil, state, sigma);
  state->j = isfinite(before) ? state->j : before + NAN;
}

// Momentum that a particle brings to the nodes: start at its base node, and its change per node
// step, a[3 * i + j] of component i along axis j [kg m/s]. A = m C dx - dt 4/dx V sigma: the affine
// part [Jiang 2015] and the stress as MLS-MPM has it [Hu 2018]. bank = mass / bank density [m3], f
// = offset from the base node [cells]. In a held step the nodes have kept their momentum, `carried`
// is 0 and the stress alone is brought; else it is 1.
INLINED void affine_momentum(const real* c, const real* sigma, const real* v, const real* f, real mass, real bank,
                             real j, scalar carried, scalar dt, scalar dx, real* start, real* a) {
  const real kept = carried * mass, cm = kept * dx, sv = (4.0f * dt / dx) * bank * j;
  a[0] = cm * c[0] - sv * sigma[0];
  a[1] = cm * c[1] - sv * sigma[3];
  a[2] = cm * c[2] - sv * sigma[5];
  a[3] = cm * c[3] - sv * sigma[3];
  a[4] = cm * c[4] - sv * sigma[1];
  a[5] = cm * c[5] - sv * sigma[4];
  a[6] = cm * c[6] - sv * sigma[5];
  a[7] = cm * c[7] - sv * sigma[4];
  a[8] = cm * c[8] - sv * sigma[2];
  start[0] = kept * v[0] - (a[0] * f[0] + a[1] * f[1] + a[2] * f[2]);
  start[1] = kept * v[1] - (a[3] * f[0] + a[4] * f[1] + a[5] * f[2]);
  start[2] = kept * v[2] - (a[6] * f[0] + a[7] * f[1] + a[8] * f[2]);
}

// Component of C = 4/dx^2 sum w v (x_i - x_p)^T [1/s] from a component of the gathered velocity v,
// its first moment about the base node along one axis [m/s x cells], and the offset f along that
// axis.
INLINED real velocity_gradient(real moment, real f, real v, scalar dx) { return (4.0f / dx) * (moment - f * v); }

// Share of the way apart that a particle goes where soil is crowded, 0 elsewhere: J is integrated
// and cannot see particles crowd, the nodes can [docs/soil.md, crowding]. Crowded is where nodes
// hold more than J and the density state both say, for `full` is the mass of a node that means
// packed at J = 1 [kg]; opened soil (J > J0) in flight is not. By shear rate, not by time: soil at
// rest stays where it is. spread: dt over the shear strain that takes soil apart [s].
INLINED real crowding(const real* c, real j, real j0, real node_mass, scalar full, scalar spread) {
  const real packed = full / fmax(node_mass, MASS_QUANTUM);
  return fmin(j, j0) > packed ? fmin(spread * strain_rate(c), 1.0f) : 0.0f;
}

#define NOISE_OPENS 1.1f  // J / J0 up to which noise opens soil; what is thrown apart opens further

// J of a particle that is open while its nodes hold a closed soil's mass: the flow's noise opens
// soil that lies closed, and would take its cohesion. It closes by a share of the way to the
// density state, where soil bears no pressure yet, so that it costs and gives no energy
// [docs/soil.md, opening]. filled: mass of a node that counts as closed at J = 1 [kg].
INLINED real seen_opening(real j, real j0, real node_mass, scalar filled, scalar share) {
  const real closing = j + share * (j0 - j);
  return j > j0 && j < NOISE_OPENS * j0 && node_mass * j0 >= filled ? closing : j;
}

// Way apart along an axis [cells], away from where the nodes hold more. lean: their mass times
// their place along it, seen from the particle [kg cells]; most: farthest way [cells].
INLINED real crowding_displacement(real share, real lean, real node_mass, scalar most) {
  return fmin(fmax(-share * lean / fmax(node_mass, MASS_QUANTUM), -most), most);
}

// Fastest component of a velocity, infinite when one is not finite.
INLINED real fastest_component(const real* v) {
  const real largest = fmax(fmax(fabs(v[0]), fabs(v[1])), fabs(v[2]));
  return isfinite(v[0] + v[1] + v[2]) ? largest : INFINITY;
}

#endif  // NAVVY_KERNELS_SOIL_POINT_H
