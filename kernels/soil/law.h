// SPDX-License-Identifier: Apache-2.0
// Soil law: stress update of a particle. One source for the kernels (sixteen lanes or one particle
// at a time), the native loop and the double-precision twin.
//
// The law combines rate-form elasticity with the yield surface of [Matsuoka 1974], matched to
// Mohr-Coulomb in plane strain [docs/soil.md, yield]. Its parts are:
//   - a yield surface that equals Mohr-Coulomb in plane strain and is close to triaxial tests;
//   - opening: a particle whose volume ratio J exceeds its density state J0 carries no stress;
//   - cohesion in shear only, which decreases with opening (opening_strain), remoulding (plastic
//         shear) and loosening (density state);
//   - swell: J0 grows with plastic shear from bank density to loose density and stops there, freely
//         where soil opens and by dilatancy where it carries little pressure;
//   - static friction: additional strength of soil that hardly shears;
//   - viscosity of soil that does not yield, so that intact ground does not ring, and of the volume
//         of closed soil;
// and, if LAW_EXTENDED is defined, so that only scenes that use them pay for them:
//   - dilatancy: shear increases J0 even against pressure, at a decreasing rate until the soil is
//         loose;
//   - compaction: pressure above the limit of the density state reduces J0 permanently;
//   - mu(I): friction grows with the inertial number of the flow.
// The law uses only + - * / sqrt min max, so that builds without contraction agree bit for bit. NaN
// inputs must remain visible, but min and max may drop them. Callers therefore check the whole
// state and not only the stress (advance_state in point.h).
//
// The source is written in the dialect of kernels/README.md: `real` is the type of computation,
// `scalar` the type of one of its elements. Literals that a float represents exactly are written as
// floats. All others are cast to scalar, so that the twin uses them in double precision.
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

#define LAW_REAL(name) real name;
// Constants of one soil; law_constants.h describes each of them.
typedef struct LawSoil {
  LAW_CONSTANTS(LAW_REAL)
} LawSoil;
#undef LAW_REAL

#define STATE_REAL(NAME, member, rest) real member;
#define STATE_REALS(NAME, member, count, rest) real member[count];
// State of a particle that the law advances; particle_fields.h describes its members.
typedef struct LawState {
  LAW_STATE_FIELDS(STATE_REAL, STATE_REALS)
} LawState;
#undef STATE_REAL
#undef STATE_REALS

// Returns the radius of the yield surface in the direction of the stress, divided by its radius in
// plane strain [Matsuoka 1974] [docs/soil.md, yield]. determinant: determinant of the deviatoric
// stress s [Pa^3]; q: sqrt(s : s / 2) [Pa]; sin_phi: sine of the friction angle.
//
// The result is the root r of a r^3 - r^2 + 1 = 0, where a follows from the arguments. It is found
// by three Newton steps from 1, of which the first is written out. 2 / sqrt(27) bounds the
// invariant of s in exact arithmetic.
INLINED real lode_radius(real determinant, real q, real sin_phi) {
  const real safe = larger(q, (scalar)(1e-3));
  const real invariant =
      smaller(larger(-determinant / (safe * safe * safe), (scalar)(-0.3849)), (scalar)(0.3849));
  const real a = 0.5f * sin_phi * (3.0f - sin_phi * sin_phi) * invariant;
  real r = 1.0f + a / (2.0f - 3.0f * a);
  for (int newton = 0; newton < 2; ++newton)
    r = r - ((a * r - 1.0f) * r * r + 1.0f) / ((3.0f * a * r - 2.0f) * r);
  return r;
}

// Returns the share of bank density in the density state j0: 1 in bank state, 0 when loose.
INLINED real dense_share(const LawSoil* soil, real j0) {
  return smaller(larger(soil->dense_offset - j0 * soil->inv_range, 0.0f), 1.0f);
}

// Returns the cohesion term of the yield stress, k = c cos phi [Pa], of soil that is not open
// [docs/soil.md, cohesion]. dense: from dense_share; shear: accumulated plastic shear strain.
INLINED real cohesion_term(const LawSoil* soil, real dense, real shear) {
  const real soft = 1.0f + shear * soil->inv_remould;
  return soil->k_loose + soil->k_dense * dense + soil->k_bond / (soft * soft);
}

// Returns the share of the cohesion that is left when J / J0 - 1 = open.
INLINED real opening_share(const LawSoil* soil, real open) {
  return smaller(larger(1.0f - open * soil->inv_opening, 0.0f), 1.0f);
}

// Advances the state by dt [s] under the velocity gradient c [1/s], row by row. sigma: output, the
// stress that acts on the grid, including pressure and viscosity [Pa], in the order xx, yy, zz, xy,
// yz, xz; positive in tension.
INLINED void law_update(const real* c, scalar dt, const LawSoil* soil, LawState* state,
                        real* sigma) {
  const real* s = state->s;
  real j = state->j, j0 = state->j0;
  const real trace = c[0] + c[4] + c[8];
  const real third = trace * (scalar)(1.0 / 3.0);
  const real dxx = c[0] - third, dyy = c[4] - third, dzz = c[8] - third;
  const real dxy = 0.5f * (c[1] + c[3]), wxy = 0.5f * (c[1] - c[3]);
  const real dyz = 0.5f * (c[5] + c[7]), wyz = 0.5f * (c[5] - c[7]);
  const real dxz = 0.5f * (c[2] + c[6]), wxz = 0.5f * (c[2] - c[6]);

  // Trial stress: elastic shear and the Jaumann rotation W s - s W [docs/soil.md, stress update].
  const real g2 = 2.0f * soil->shear;
  const real xx = s[0] + dt * (g2 * dxx + 2.0f * (wxy * s[3] + wxz * s[5]));
  const real yy = s[1] + dt * (g2 * dyy + 2.0f * (wyz * s[4] - wxy * s[3]));
  const real zz = s[2] + dt * (g2 * dzz - 2.0f * (wxz * s[5] + wyz * s[4]));
  const real xy = s[3] + dt * (g2 * dxy + wxy * (s[1] - s[0]) + wxz * s[4] + wyz * s[5]);
  const real yz = s[4] + dt * (g2 * dyz + wyz * (s[2] - s[1]) - wxy * s[5] - wxz * s[3]);
  const real xz = s[5] + dt * (g2 * dxz + wxz * (s[2] - s[0]) + wxy * s[4] - wyz * s[3]);

  // Pressure follows from the tracked volume; opened soil has none [Dunatunga 2015]
  // [docs/soil.md, opening]. The lower limit keeps p finite. The upper limit is far above any soil
  // in flight: a loose particle that is stuck to a plate would open without end, and mixing would
  // open its cell.
  j = smaller(larger(j * (1.0f + dt * trace), SCHEME(min_volume_ratio)), SCHEME(max_volume_ratio));
#ifdef LAW_EXTENDED
  // One Newton step towards the density state that carries the pressure. Loosened soil carries
  // little until it is dense again [docs/soil.md, compaction].
  const real line = 1.0f + soil->cap_growth * (1.0f - j0);
  const real over =
      larger(soil->bulk * (1.0f - j / j0) - soil->cap * larger(line, (scalar)(0.05)), 0.0f);
  const real slope = soil->bulk / j0 + soil->cap * soil->cap_growth * step((scalar)(0.05), line);
  j0 = larger(j0 - over / slope, smaller(j0, SCHEME(min_density_state)));
#endif
  const real open = j / j0 - 1.0f;
  const real p = soil->bulk * larger(-open, 0.0f);

  // Yield stress from the cohesion of the density state and of the remaining bonds, faded by
  // opening [docs/soil.md, cohesion], then radial return [Klar 2016]
  // [docs/soil.md, return mapping].
  const real dense = dense_share(soil, j0);
  const real k = cohesion_term(soil, dense, state->shear);
  const real fade = opening_share(soil, open);
  const real rate =
      sqrt(2.0f * (dxx * dxx + dyy * dyy + dzz * dzz) + 4.0f * (dxy * dxy + dyz * dyz + dxz * dxz));
#ifdef LAW_EXTENDED
  // mu(I) [Jop 2006], applied to sin phi [docs/soil.md, flow rate].
  const real flow = soil->grain * rate;
  const real fast = flow / (flow + soil->inertial * sqrt(p) + (scalar)(1e-9));
  const real sin_phi = soil->alpha + soil->alpha_fast * fast;
#else
  const real sin_phi = soil->alpha;
#endif
  const real q = sqrt(0.5f * (xx * xx + yy * yy + zz * zz) + (xy * xy + yz * yz + xz * xz));
  const real determinant =
      xx * (yy * zz - yz * yz) - xy * (xy * zz - yz * xz) + xz * (xy * yz - yy * xz);
  real strength =
      lode_radius(determinant, q, sin_phi) *
      (1.0f + soil->static_share * larger(1.0f - rate * SCHEME(static_friction_time), 0.0f));
#ifdef LAW_EXTENDED
  strength = strength * (1.0f + soil->matched * dense);
#endif
  const real alpha = strength * sin_phi;
  const real q_yield = alpha * p + strength * k * fade;
  const real keep = smaller(q_yield / larger(q, (scalar)(1e-9)), 1.0f);
#ifdef LAW_EXTENDED
  // Closed soil that dilates raises its own pressure as it slips. Part of the return is therefore a
  // rise of the yield stress [docs/soil.md, dilatancy].
  const real b = soil->dilatancy * dense;
  const real harder = alpha * soil->bulk * b * step(0.0f, -open);
  const real slip = q * (1.0f - keep) / (soil->shear + harder);
  const real stay = keep + (1.0f - keep) * (harder / (soil->shear + harder));
  j0 = smaller(j0 * (1.0f + b * slip), larger(soil->swell, j0));
  const real pressure = soil->bulk * larger(1.0f - j / j0, 0.0f);
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

  // Viscosity acts where the step was elastic, and on the volume of closed soil. It is only in the
  // stress that acts on the grid; the yield stress used the pressure without it
  // [docs/soil.md, viscosity].
  const real eta2 = 2.0f * soil->viscosity * step(1.0f, keep);
  const real damped = larger(pressure - SCHEME(volume_damping) * soil->viscosity * trace, 0.0f);
  const real applied = pressure > 0.0f ? damped : pressure;
  sigma[0] = s[0] + eta2 * dxx - applied;
  sigma[1] = s[1] + eta2 * dyy - applied;
  sigma[2] = s[2] + eta2 * dzz - applied;
  sigma[3] = s[3] + eta2 * dxy;
  sigma[4] = s[4] + eta2 * dyz;
  sigma[5] = s[5] + eta2 * dxz;

  // Plastic shear loosens the density state [docs/soil.md, swell]: up to J quickly, because this
  // creates no pressure, and beyond it by dilatancy, which grows as bonds break and fades with
  // pressure and density. Compacted soil does not, and soil with a dilatancy angle of its own has
  // dilated above.
  state->shear = state->shear + slip;
  const real broken = smaller(state->shear * soil->inv_remould, 1.0f);
  const real pressed = p * (1.0f / SCHEME(dilatancy_pressure));
  real dilates = dense * larger(1.0f - pressed, 0.0f) * broken;
#ifdef LAW_EXTENDED
  dilates = dilates * step(0.0f, -soil->dilatancy) * step(1.0f, j0);
#endif
  const real dilated = j0 * (1.0f + SCHEME(bank_dilatancy) * dilates * slip);
  const real grown = larger(smaller(j0 + soil->loosening * slip, j), dilated);
  state->j0 = larger(j0, smaller(grown, soil->swell));
  state->j = j;
}

#endif  // NAVVY_KERNELS_SOIL_LAW_H
