// SPDX-License-Identifier: Apache-2.0
// Constants of the soil law for the double-precision twin.
#pragma once

#include "scene/soil.h"
#include "soil/host_law/double_law.h"
#include "soil/particles/soil_table.h"

namespace navvy::soil::reference {

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
