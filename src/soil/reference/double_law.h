// SPDX-License-Identifier: Apache-2.0
// The soil law of kernels/soil/law.h compiled for doubles.
#pragma once

#include <algorithm>
#include <cmath>

#include "scene/soil.h"
#include "soil/layout.h"
#include "soil/particles/soil_table.h"

namespace navvy::soil::reference {

#define LAW_T double
#define LAW_EXTENDED
#define LAW_LIT(x) (x)
#define LAW_MIN(a, b) std::fmin(a, b)
#define LAW_MAX(a, b) std::fmax(a, b)
#define LAW_SQRT(a) std::sqrt(a)
#define LAW_STEP(edge, x) ((x) < (edge) ? 0.0 : 1.0)
#define LAW_FN inline
#include "soil/law.h"  // NOLINT: on purpose inside the namespace
#undef LAW_T
#undef LAW_EXTENDED
#undef LAW_LIT
#undef LAW_MIN
#undef LAW_MAX
#undef LAW_SQRT
#undef LAW_STEP
#undef LAW_FN

inline LawSoil law_soil(const scene::Soil& soil, double cell) {
  const LawConstants k = law_constants(soil, cell);
  return {k.bulk,        k.shear,      k.alpha, k.k_residual, k.k_bond,    k.inv_remould,
          k.inv_opening, k.viscosity,  k.swell, k.loosening,  k.dilatancy, k.inv_range,
          k.matched,     k.alpha_fast, k.grain, k.inertial,   k.cap,       k.cap_growth};
}

}  // namespace navvy::soil::reference
