// SPDX-License-Identifier: Apache-2.0
#include "lab/soils.h"

#include <cmath>

#include "core/error.h"
#include "core/math.h"

namespace navvy::lab {

scene::Soil clean_sand(double phi_degrees) {
  scene::Soil soil;
  soil.name = "sand";
  // A soil for experiments, not a measured one.
  soil.source = "laboratory default";
  soil.bank_density = 1600;
  // No swell: a bed keeps its volume, which most closed forms assume.
  soil.swell = 1;
  soil.friction_angle = radians(phi_degrees);
  soil.cohesion = soil.residual_cohesion = 0;
  soil.tool_friction_angle = radians(20);
  return soil;
}

scene::Soil cohesive(double phi_degrees, double cohesion) {
  scene::Soil soil = clean_sand(phi_degrees);
  soil.name = "cohesive";
  // Remoulding changes nothing: a failed cut has the strength of a standing one.
  soil.cohesion = soil.residual_cohesion = cohesion;
  return soil;
}

scene::Soil without_tool_friction(scene::Soil soil) {
  soil.tool_friction_angle = soil.adhesion = 0;
  return soil;
}

double friction_from_repose(double repose) {
  // Flowing soil mobilises tau / sigma_n = sin phi on the slope at which it comes to rest.
  const double sine = std::tan(repose);
  // By this rule friction alone holds no slope beyond 45 degrees.
  if (repose > 0 && sine < 1) return std::asin(sine);
  throw InputError(Fault{Fault::Severity::kError, "", 0, "repose",
                         std::to_string(degrees(repose)) + " deg", "above 0 and below 45 degrees",
                         "give phi and cohesion instead"});
}

// A billionth is rounding of a file's value.
bool softens(const scene::Soil& soil) {
  return soil.residual_cohesion < soil.cohesion * (1 - 1e-9);
}

}  // namespace navvy::lab
