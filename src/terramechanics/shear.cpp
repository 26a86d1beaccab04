// SPDX-License-Identifier: Apache-2.0
#include "terramechanics/shear.h"

#include <algorithm>
#include <cmath>

namespace navvy::terramechanics {

ShearStrength rim_strength(const scene::Soil& soil) {
  // Friction decides which layer slides: under a loaded rim it exceeds cohesion by far.
  const bool steel = soil.tool_friction_angle < soil.friction_angle;
  return {steel ? soil.adhesion : soil.residual_cohesion,
          std::tan(steel ? soil.tool_friction_angle : soil.friction_angle)};
}

// Cohesion follows the density; friction does not.
ShearStrength surface_strength(const SoilState& ground) {
  if (ground.soil == nullptr) return {};
  const scene::Soil& soil = *ground.soil;
  // Soil without swell is as strong loose as in bank state. Soil with swell loses cohesion by the
  // law in [docs/soil.md, cohesion].
  const double swollen =
      soil.swell > 1 ? std::clamp((ground.volume_ratio - 1) / (soil.swell - 1), 0.0, 1.0) : 0.0;
  const double loose = std::min(soil.loose_cohesion, soil.residual_cohesion);
  return {soil.cohesion + swollen * (loose - soil.cohesion), std::tan(soil.friction_angle)};
}

double mobilised_share(double displacement, double janosi_k) {
  return 1 - std::exp(-std::abs(displacement) / janosi_k);
}

double shear_stress(const ShearStrength& strength, double pressure, double displacement,
                    double janosi_k) {
  // The result has the displacement's sign, and is zero without displacement.
  return std::copysign(strength.cohesion + pressure * strength.slope, displacement) *
         mobilised_share(displacement, janosi_k);
}

}  // namespace navvy::terramechanics
