// SPDX-License-Identifier: Apache-2.0
// Soil law and particle arithmetic of kernels/soil/law.h and point.h, compiled in double precision.
#pragma once

#include "scene/soil.h"
#include "soil/particles/soil_table.h"
#include "soil/reference/double_real.h"

namespace navvy::soil::reference {

// With all extensions of the law: those that a soil does not use have no effect.
#define LAW_EXTENDED
#include "soil/point.h"  // NOLINT: on purpose inside the namespace
#undef LAW_EXTENDED

/// Returns the constants of the soil law for one soil in double precision. `cell`: edge of a cell
/// [m]. The kernels use the same constants rounded to floats.
inline LawSoil law_soil(const scene::Soil& soil, double cell) {
  const LawConstants law = law_constants(soil, cell);
  LawSoil out;
#define TWIN_CONSTANT(name) out.name = law.name;
  LAW_CONSTANTS(TWIN_CONSTANT)
#undef TWIN_CONSTANT
  return out;
}

}  // namespace navvy::soil::reference
