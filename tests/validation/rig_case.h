// SPDX-License-Identifier: Apache-2.0
// One run of a rig that must meet its tolerances: the element of the laboratory's parameterised
// cases.
#pragma once

#include <map>
#include <ostream>
#include <string>

#include "core/math.h"
#include "lab/run_rig.h"
#include "validation/report.h"

namespace navvy::validation {

/// Changes of a case to the rig's default soil; kNone keeps the default.
struct SoilChange {
  /// Friction angle [deg].
  double phi_degrees = lab::kNone;
  /// Cohesion, also the residual one [Pa].
  double cohesion = lab::kNone;
  double young = lab::kNone;         ///< Young's modulus [Pa]
  double swell = lab::kNone;         ///< loose volume / bank volume [-]
  double bank_density = lab::kNone;  ///< [kg/m3]

  void apply(scene::Soil& soil) const {
    const auto set = [](double& value, double wanted) {
      value = std::isnan(wanted) ? value : wanted;
    };
    set(soil.friction_angle, radians(phi_degrees));
    set(soil.cohesion, cohesion);
    set(soil.residual_cohesion, cohesion);
    set(soil.young_modulus, young);
    set(soil.swell, swell);
    set(soil.bank_density, bank_density);
  }
};

struct RigCase {
  /// Name of the test.
  const char* name;
  const char* rig;
  /// Parameters other than the rig's defaults.
  std::map<std::string, double> geometry;
  double cell = lab::kNone;  ///< kNone: the rig's default [m]
  SoilChange soil = {};
};

inline void PrintTo(const RigCase& c, std::ostream* out) { *out << c.rig; }
inline std::string case_name(const testing::TestParamInfo<RigCase>& tested) {
  return tested.param.name;
}

/// Runs the rig and compares it with its tolerances.
inline void expect_tolerances(const RigCase& c) {
  expect_tolerances(lab::run_rig(c.rig, c.geometry, [&](lab::Setup& setup) {
    if (!std::isnan(c.cell)) setup.cell = c.cell;
    c.soil.apply(setup.soil);
  }));
}

}  // namespace navvy::validation
