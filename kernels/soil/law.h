// SPDX-License-Identifier: Apache-2.0
// The soil law: one source for the kernels (sixteen lanes or one particle), the native loop and the
// double twin.
//
// Rate-form elasticity under the cone of [Matsuoka 1974], matched in plane strain
// [docs/soil.md, yield], with
//   - a cone of yield stress that is no circle: plane strain is Mohr and Coulomb, triaxial states
//     are near it;
//   - opening memory: a particle whose volume ratio J exceeds its density state J0 carries no
//     stress until it closes;
//   - cohesion in shear only; it fades as soil opens (opening_strain), is remoulded (plastic shear)
//     and gets looser (density state);
//   - swell: J0 grows with plastic shear from bank to loose density and stops there;
//   - a static share of its strength, which soil that hardly shears has on top;
//   - viscosity on soil that does not yield, so that intact ground does not ring, and on the volume
//     of closed soil;
// and, where LAW_EXTENDED is defined (a scene whose soils have them; the rest need not pay),
//   - dilatancy: shear widens J0 also against pressure, less and less until it is loose;
//   - compaction: pressure above what the density state bears makes J0 denser for good;
//   - mu(I): friction grows with the inertial number of the flow.
// Only + - * / sqrt min max, so that contraction-free builds agree bit for bit. NaN inputs must
// stay visible: min and max may drop them, which is why callers check the whole state and not only
// the stress (advance_state in point.h).
//
// Written in the dialect of kernels/README.md: `real` is what is computed with, `scalar` its
// element. Literals that a float holds exactly stand as floats; the others are cast to scalar, so
// that the twin has them in double.
#ifndef NAVVY_KERNELS_SOIL_LAW_H
#define NAVVY_KERNELS_SOIL_LAW_H

#include "soil/law_constants.h"
#include "soil/layout.h"
#include "soil/particle_fields.h"

#ifdef LAW_EXTENDED
#define LAW_CONSTANTS(X) ALL_LAW_CONSTANTS(X)
#else
#define LAW_CONSTANTS(X) BASIC_LAW_CONSTANTS(X)
#endif

// One soil as the law needs it, see law_constants.h.
#define LAW_REAL(name) real name;
typedef struct LawSoil {
  LAW_CONSTANTS(LAW_REAL)
} LawSoil;
#undef LAW_REAL

// What the law advances, see particle_fields.h.
#define STATE_REAL(NAME, member, rest) real member;
#define STATE_REALS(NAME, member, count, rest) real member[count];
typedef struct LawState {
  LAW_STATE_FIELDS(STATE_REAL, STATE_REALS)
} LawState;
#undef STATE_REAL
#undef STATE_REALS

#define MOST_OPEN 100.0f      // J at most [docs/soil.md, opening]
#define RESTING_TIME 10.0f    // 1 / shear rate at which the static share is gone [s] [docs/soil.md, static friction]
#define VOLUME_DAMPING 10.0f  // viscosity of closed soil's volume / that of its shear [docs/soil.md, viscosity]

// Radius of the yield surface / that in plane strain, of the deviator's determinant and q: r of a
// r^3 - r^2 + 1 = 0 [Matsuoka 1974] [docs/soil.md, yield]. Three Newton steps from 1, the first
// written out; 2 / sqrt(27) is the invariant's bound.
INLINED real lode_radius(real determinant, real q, real sin_phi) {
  const real safe = fmax(q, (scalar)(1e-3));
  const real invariant = fmin(fmax(-determinant / (safe * safe * safe), (scalar)(-0.3849)), (scalar)(0.3849));
  const real a = 0.5f * sin_phi * (3.0f - sin_phi * sin_phi) * invariant;
  real r = 1.0f + a / (2.0f - 3.0f * a);
  for (int newton = 0; newton < 2; ++newton)
    r = r - ((a * r - 1.0f) * r * r + 1.0f) / ((3.0f * a * r - 2.0f) * r);
  return r;
}

// Advances the state by dt [s] under the velocity gradient c. sigma: the stress the grid feels,
// order of state->s, with pressure and viscosity. Positive in tension.
INLINED void law_update(const real* c, scalar dt, const LawSoil* soil, LawState* state, real* sigma) {
  const real* s = state->s;
  real j = state->j, j0 = state->j0;
  const real trace = c[0] + c[4] + c[8];
  const real third = trace * (scalar)(1.0 / 3.0);
  const real dxx = c[0] - third, dyy = c[4] - third, dzz = c[8] - third;
  const real dxy = 0.5f * (c[1] + c[3]), wxy = 0.5f * (c[1] - c[3]);
  const real dyz = 0.5f * (c[5] + c[7]), wyz = 0.5f * (c[5] - c[7]);
  const real dxz = 0.5f * (c[2] + c[6]), wxz = 0.5f * (c[2] - c[6]);

  // Trial stress: elastic shear plus the Jaumann turn W s - s W [docs/soil.md, stress update].
  const real g2 = 2.0f * soil->shear;
  const real xx = s[0] + dt * (g2 * dxx + 2.0f * (wxy * s[3] + wxz * s[5]));
  const real yy = s[1] + dt * (g2 * dyy + 2.0f * (wyz * s[4] - wxy * s[3]));
  const real zz = s[2] + dt * (g2 * dzz - 2.0f * (wxz * s[5] + wyz * s[4]));
  const real xy = s[3] + dt * (g2 * dxy + wxy * (s[1] - s[0]) + wxz * s[4] + wyz * s[5]);
  const real yz = s[4] + dt * (g2 * dyz + wyz * (s[2] - s[1]) - wxy * s[5] - wxz * s[3]);
  const real xz = s[5] + dt * (g2 * dxz + wxz * (s[2] - s[0]) + wxy * s[4] - wyz * s[3]);

  // Pressure from the tracked volume; opened soil has none [Dunatunga 2015]
  // [docs/soil.md, opening]. A floor far below any real state: p stays finite. A ceiling far above
  // any load that is thrown: a crumb that hangs at a plate opens without end, and its cell with it
  // by mixing.
  j = fmin(fmax(j * (1.0f + dt * trace), (scalar)(0.2)), MOST_OPEN);
#ifdef LAW_EXTENDED
  // One step towards the density state that bears the pressure; loosened soil bears little until it
  // is dense again [docs/soil.md, compaction].
  const real line = 1.0f + soil->cap_growth * (1.0f - j0);
  const real over = fmax(soil->bulk * (1.0f - j / j0) - soil->cap * fmax(line, (scalar)(0.05)), 0.0f);
  const real slope = soil->bulk / j0 + soil->cap * soil->cap_growth * step((scalar)(0.05), line);
  j0 = fmax(j0 - over / slope, fmin(j0, (scalar)(DENSEST_STATE)));
#endif
  const real open = j / j0 - 1.0f;
  const real p = soil->bulk * fmax(-open, 0.0f);

  // Yield stress: cohesion of the density state and of the bonds that are left, faded
  // [docs/soil.md, cohesion]; return [Klar 2016] [docs/soil.md, return mapping].
  const real dense = fmin(fmax(soil->dense_offset - j0 * soil->inv_range, 0.0f), 1.0f);
  const real soft = 1.0f + state->shear * soil->inv_remould;
  const real k = soil->k_loose + soil->k_dense * dense + soil->k_bond / (soft * soft);
  const real fade = fmin(fmax(1.0f - open * soil->inv_opening, 0.0f), 1.0f);
  const real rate =
      sqrt(2.0f * (dxx * dxx + dyy * dyy + dzz * dzz) + 4.0f * (dxy * dxy + dyz * dyz + dxz * dxz));
#ifdef LAW_EXTENDED
  // mu(I) [Jop 2006] on sin phi [docs/soil.md, flow rate].
  const real flow = soil->grain * rate;
  const real fast = flow / (flow + soil->inertial * sqrt(p) + (scalar)(1e-9));
  const real sin_phi = soil->alpha + soil->alpha_fast * fast;
#else
  const real sin_phi = soil->alpha;
#endif
  const real q = sqrt(0.5f * (xx * xx + yy * yy + zz * zz) + (xy * xy + yz * yz + xz * xz));
  const real determinant = xx * (yy * zz - yz * yz) - xy * (xy * zz - yz * xz) + xz * (xy * yz - yy * xz);
  real strength = lode_radius(determinant, q, sin_phi) *
                  (1.0f + soil->static_share * fmax(1.0f - rate * RESTING_TIME, 0.0f));
#ifdef LAW_EXTENDED
  strength = strength * (1.0f + soil->matched * dense);
#endif
  const real alpha = strength * sin_phi;
  const real q_yield = alpha * p + strength * k * fade;
  const real keep = fmin(q_yield / fmax(q, (scalar)(1e-9)), 1.0f);
#ifdef LAW_EXTENDED
  // Dilating soil that is closed presses itself harder as it slips: part of the way back is the
  // yield stress coming up [docs/soil.md, dilatancy].
  const real b = soil->dilatancy * dense;
  const real harder = alpha * soil->bulk * b * step(0.0f, -open);
  const real slip = q * (1.0f - keep) / (soil->shear + harder);
  const real stay = keep + (1.0f - keep) * (harder / (soil->shear + harder));
  j0 = fmin(j0 * (1.0f + b * slip), fmax(soil->swell, j0));
  const real pressure = soil->bulk * fmax(1.0f - j / j0, 0.0f);
#else
  const real slip = q * (1.0f - keep) / soil->shear;
  const real stay = keep, pressure = p;
#endif
  state->s[0] = xx * stay;
  state->s[1] = yy * stay;
  state->s[2] = zz * stay;
  state->s[3] = xy * stay;
  state->s[4] = yz * stay;
  state->s[5] = xz * stay;

  // Viscosity where the step was elastic, and on the volume of closed soil: only in the stress that
  // the grid feels, yield has asked the pressure without it [docs/soil.md, viscosity].
  const real eta2 = 2.0f * soil->viscosity * step(1.0f, keep);
  const real damped = fmax(pressure - VOLUME_DAMPING * soil->viscosity * trace, 0.0f);
  const real felt = pressure > 0.0f ? damped : pressure;
  sigma[0] = s[0] + eta2 * dxx - felt;
  sigma[1] = s[1] + eta2 * dyy - felt;
  sigma[2] = s[2] + eta2 * dzz - felt;
  sigma[3] = s[3] + eta2 * dxy;
  sigma[4] = s[4] + eta2 * dyz;
  sigma[5] = s[5] + eta2 * dxz;

  // Plastic shear, and the density state it loosens [docs/soil.md, swell]: never further than J
  // allows, so that loosening makes no pressure out of nothing.
  state->shear = state->shear + slip;
  const real grown = fmin(j0 + soil->loosening * slip, j);
  state->j0 = fmax(j0, fmin(grown, soil->swell));
  state->j = j;
}

#endif  // NAVVY_KERNELS_SOIL_LAW_H
