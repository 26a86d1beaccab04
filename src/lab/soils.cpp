// SPDX-License-Identifier: Apache-2.0
#include "lab/soils.h"

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

void set_friction(scene::Soil& soil, scene::FrictionTest test, double angle) {
  soil.friction_test = test;
  soil.friction_angle = soil.tested_friction_angle = angle;
}

// A billionth is rounding of a file's value.
bool softens(const scene::Soil& soil) {
  return soil.residual_cohesion < soil.cohesion * (1 - 1e-9);
}

}  // namespace navvy::lab
