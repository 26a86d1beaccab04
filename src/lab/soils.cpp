// SPDX-License-Identifier: Apache-2.0
#include "lab/soils.h"

#include <cmath>

#include "core/error.h"
#include "core/math.h"

namespace navvy::lab {

scene::Soil clean_sand(double phi_degrees) {
  scene::Soil soil;
  soil.name = "sand";
  soil.source = "laboratory default";
  soil.bank_density = 1600;
  soil.swell = 1;
  soil.friction_angle = radians(phi_degrees);
  soil.cohesion = soil.residual_cohesion = 0;
  soil.tool_friction_angle = radians(20);
  return soil;
}

scene::Soil cohesive(double phi_degrees, double cohesion) {
  scene::Soil soil = clean_sand(phi_degrees);
  soil.name = "cohesive";
  soil.cohesion = soil.residual_cohesion = cohesion;
  return soil;
}

double friction_from_repose(double repose) {
  const double sine = std::tan(repose);
  if (repose > 0 && sine < 1) return std::asin(sine);
  throw InputError(Fault{Fault::Severity::kError, "", 0, "repose", std::to_string(degrees(repose)) + " deg",
                         "above 0 and below 45 degrees", "give phi and cohesion instead"});
}

}  // namespace navvy::lab
