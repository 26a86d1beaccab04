// SPDX-License-Identifier: Apache-2.0
// The soil law: one source for the kernels (lanes of float16) and for the double-precision reference.
//
// Rate-form Drucker-Prager, plane-strain matched, with
//   - opening memory: a particle whose volume ratio J exceeds its density state J0 carries no stress until it closes;
//   - cohesion in shear only; it fades as soil opens (opening_strain) and as it is remoulded (plastic shear);
//   - swell: J0 grows with plastic shear from bank to loose density and stops there;
//   - viscosity on soil that does not yield, so that intact ground does not ring;
// and, where LAW_EXTENDED is defined (a scene whose soils have them; the rest need not pay),
//   - dilatancy: shear widens J0 also against pressure, less and less until it is loose;
//   - compaction: pressure above what the density state bears makes J0 denser for good;
//   - mu(I): friction grows with the inertial number of the flow.
// Only + - * / sqrt min max, so that contraction-free builds agree bit for bit.
//
// The includer defines before inclusion: LAW_T (scalar or lanes), LAW_LIT(x) (a literal of its scalar type), LAW_MIN,
// LAW_MAX, LAW_SQRT, LAW_STEP(edge, x) (0 where x < edge, else 1) and LAW_FN (function specifiers). NaN inputs must stay
// visible: min and max may drop them, which is why callers check the whole state and not only the stress.
#ifndef NAVVY_KERNELS_SOIL_LAW_H
#define NAVVY_KERNELS_SOIL_LAW_H

// One soil as the law needs it. Stresses [Pa].
typedef struct LawSoil {
  LAW_T bulk;        // K
  LAW_T shear;       // G
  LAW_T alpha;       // sin(friction angle)
  LAW_T k_residual;  // residual cohesion x cos(friction angle)
  LAW_T k_bond;      // (intact - residual cohesion) x cos(friction angle)
  LAW_T inv_remould; // 1 / remoulding strain
  LAW_T inv_opening; // 1 / opening strain
  LAW_T viscosity;   // [Pa s], where it does not yield
  LAW_T swell;       // largest J0
  LAW_T loosening;   // growth of J0 per plastic shear, as far as J allows
#ifdef LAW_EXTENDED
  LAW_T dilatancy;   // b: plastic volume strain per plastic shear in bank state
  LAW_T inv_range;   // 1 / (swell - 1), 0 without swell
  LAW_T matched;     // yield stress that plane strain needs at b / that without dilatancy - 1
  LAW_T alpha_fast;  // growth of alpha from slow to fast flow
  LAW_T grain;       // diameter x sqrt(density) of the grains
  LAW_T inertial;    // inertial number at half that growth
  LAW_T cap;         // mean pressure that bank soil bears without getting denser
  LAW_T cap_growth;  // growth of it, as a share, per volume strain
#endif
} LawSoil;

// Advances stress and state by dt [s] under the velocity gradient c (row major, c[3*i+j] = dv_i/dx_j [1/s]).
// s: deviatoric stress xx yy zz xy yz xz; j: volume ratio; j0: density state; shear: plastic shear.
// sigma: the stress the grid feels, same order, with pressure and viscosity. Positive in tension.
LAW_FN void law_update(const LAW_T* c, LAW_T dt, const LawSoil* soil, LAW_T* s, LAW_T* j, LAW_T* j0, LAW_T* shear,
                       LAW_T* sigma) {
  const LAW_T trace = c[0] + c[4] + c[8];
  const LAW_T third = trace * LAW_LIT(1.0 / 3.0);
  const LAW_T dxx = c[0] - third, dyy = c[4] - third, dzz = c[8] - third;
  const LAW_T dxy = LAW_LIT(0.5) * (c[1] + c[3]), wxy = LAW_LIT(0.5) * (c[1] - c[3]);
  const LAW_T dyz = LAW_LIT(0.5) * (c[5] + c[7]), wyz = LAW_LIT(0.5) * (c[5] - c[7]);
  const LAW_T dxz = LAW_LIT(0.5) * (c[2] + c[6]), wxz = LAW_LIT(0.5) * (c[2] - c[6]);

  // Trial stress: elastic shear plus the Jaumann turn W s - s W.
  const LAW_T g2 = LAW_LIT(2.0) * soil->shear;
  const LAW_T xx = s[0] + dt * (g2 * dxx + LAW_LIT(2.0) * (wxy * s[3] + wxz * s[5]));
  const LAW_T yy = s[1] + dt * (g2 * dyy + LAW_LIT(2.0) * (wyz * s[4] - wxy * s[3]));
  const LAW_T zz = s[2] + dt * (g2 * dzz - LAW_LIT(2.0) * (wxz * s[5] + wyz * s[4]));
  const LAW_T xy = s[3] + dt * (g2 * dxy + wxy * (s[1] - s[0]) + wxz * s[4] + wyz * s[5]);
  const LAW_T yz = s[4] + dt * (g2 * dyz + wyz * (s[2] - s[1]) - wxy * s[5] - wxz * s[3]);
  const LAW_T xz = s[5] + dt * (g2 * dxz + wxz * (s[2] - s[0]) + wxy * s[4] - wyz * s[3]);

  // Pressure from the tracked volume; opened soil has none.
  *j = LAW_MAX(*j * (LAW_LIT(1.0) + dt * trace), LAW_LIT(0.2));  // a floor far below any real state: p stays finite
#ifdef LAW_EXTENDED
  // One step towards the density state that bears the pressure; loosened soil bears little until it is dense again.
  const LAW_T line = LAW_LIT(1.0) + soil->cap_growth * (LAW_LIT(1.0) - *j0);
  const LAW_T over =
      LAW_MAX(soil->bulk * (LAW_LIT(1.0) - *j / *j0) - soil->cap * LAW_MAX(line, LAW_LIT(0.05)), LAW_LIT(0.0));
  const LAW_T slope = soil->bulk / *j0 + soil->cap * soil->cap_growth * LAW_STEP(LAW_LIT(0.05), line);
  *j0 = LAW_MAX(*j0 - over / slope, LAW_MIN(*j0, LAW_LIT(DENSEST_STATE)));
#endif
  const LAW_T open = *j / *j0 - LAW_LIT(1.0);
  const LAW_T p = soil->bulk * LAW_MAX(-open, LAW_LIT(0.0));

  // Yield stress, radial return.
  const LAW_T soft = LAW_LIT(1.0) + *shear * soil->inv_remould;
  const LAW_T fade = LAW_MIN(LAW_MAX(LAW_LIT(1.0) - open * soil->inv_opening, LAW_LIT(0.0)), LAW_LIT(1.0));
#ifdef LAW_EXTENDED
  const LAW_T dense = LAW_MIN(LAW_MAX((soil->swell - *j0) * soil->inv_range, LAW_LIT(0.0)), LAW_LIT(1.0));
  const LAW_T rate = LAW_SQRT(LAW_LIT(2.0) * (dxx * dxx + dyy * dyy + dzz * dzz) +
                              LAW_LIT(4.0) * (dxy * dxy + dyz * dyz + dxz * dxz));
  const LAW_T flow = soil->grain * rate;
  const LAW_T fast = flow / (flow + soil->inertial * LAW_SQRT(p) + LAW_LIT(1e-9));
  const LAW_T scale = LAW_LIT(1.0) + soil->matched * dense;
  const LAW_T alpha = scale * (soil->alpha + soil->alpha_fast * fast);
  const LAW_T q_yield = alpha * p + scale * (soil->k_residual + soil->k_bond / (soft * soft)) * fade;
#else
  const LAW_T q_yield = soil->alpha * p + (soil->k_residual + soil->k_bond / (soft * soft)) * fade;
#endif
  const LAW_T q =
      LAW_SQRT(LAW_LIT(0.5) * (xx * xx + yy * yy + zz * zz) + (xy * xy + yz * yz + xz * xz));
  const LAW_T keep = LAW_MIN(q_yield / LAW_MAX(q, LAW_LIT(1e-9)), LAW_LIT(1.0));
#ifdef LAW_EXTENDED
  // Dilating soil that is closed presses itself harder as it slips: part of the way back is the yield stress coming up.
  const LAW_T b = soil->dilatancy * dense;
  const LAW_T harder = alpha * soil->bulk * b * LAW_STEP(LAW_LIT(0.0), -open);
  const LAW_T slip = q * (LAW_LIT(1.0) - keep) / (soil->shear + harder);
  const LAW_T stay = keep + (LAW_LIT(1.0) - keep) * (harder / (soil->shear + harder));
  *j0 = LAW_MIN(*j0 * (LAW_LIT(1.0) + b * slip), LAW_MAX(soil->swell, *j0));
  const LAW_T pressure = soil->bulk * LAW_MAX(LAW_LIT(1.0) - *j / *j0, LAW_LIT(0.0));
#else
  const LAW_T slip = q * (LAW_LIT(1.0) - keep) / soil->shear;
  const LAW_T stay = keep, pressure = p;
#endif
  s[0] = xx * stay;
  s[1] = yy * stay;
  s[2] = zz * stay;
  s[3] = xy * stay;
  s[4] = yz * stay;
  s[5] = xz * stay;

  // Viscosity where the step was elastic.
  const LAW_T eta2 = LAW_LIT(2.0) * soil->viscosity * LAW_STEP(LAW_LIT(1.0), keep);
  sigma[0] = s[0] + eta2 * dxx - pressure;
  sigma[1] = s[1] + eta2 * dyy - pressure;
  sigma[2] = s[2] + eta2 * dzz - pressure;
  sigma[3] = s[3] + eta2 * dxy;
  sigma[4] = s[4] + eta2 * dyz;
  sigma[5] = s[5] + eta2 * dxz;

  // Plastic shear, and the density state it loosens: never further than J allows, so that
  // loosening makes no pressure out of nothing.
  *shear = *shear + slip;
  const LAW_T grown = LAW_MIN(*j0 + soil->loosening * slip, *j);
  *j0 = LAW_MAX(*j0, LAW_MIN(grown, soil->swell));
}

#endif  // NAVVY_KERNELS_SOIL_LAW_H
