// SPDX-License-Identifier: Apache-2.0
// The wheel law compared with measured smooth wheels: its stiffness and one coefficient of slip
// sinkage are fitted at two slips, the others are predicted.
#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <string>
#include <vector>

#include "core/math.h"
#include "terramechanics/rigid_wheel.h"
#include "validation/report.h"

namespace navvy::terramechanics {
namespace {

struct Row {
  double slip, load, pull, sinkage;  ///< [-], [N], [N], [mm]
};

/// A published single-wheel test.
struct Experiment {
  WheelCase wheel;
  scene::Soil soil;
  /// Rows with a tolerance.
  std::vector<Row> rows;
  /// Fitted rows: stiffness on the first, slip sinkage on the second.
  Row rolling, slipping;
  std::string source;
};

double bisect(double low, double high, const std::function<bool(double)>& beyond) {
  for (int i = 0; i < 60; ++i) {
    const double middle = std::sqrt(low * high);
    (beyond(middle) ? high : low) = middle;
  }
  return std::sqrt(low * high);
}

WheelForce at(const Experiment& e, const Row& row) {
  WheelCase wheel = e.wheel;
  wheel.load = row.load, wheel.slip = row.slip;
  return rigid_wheel(wheel, e.soil);
}

void fit(Experiment& e) {
  e.soil.bekker_kphi = bisect(1e4, 1e10, [&](double k) {
    e.soil.bekker_kphi = k;
    return 1000 * at(e, e.rolling).sinkage < e.rolling.sinkage;
  });
  e.wheel.slip_sinkage = bisect(1e-3, 3, [&](double a) {
    e.wheel.slip_sinkage = a;
    return 1000 * at(e, e.slipping).sinkage > e.slipping.sinkage;
  });
  std::printf("[ VALUE    ] k %.3g N/m^(n+2), slip sinkage %.3g\n", e.soil.bekker_kphi,
              e.wheel.slip_sinkage);
}

/// Expects sinkage within 30 %, and pull within 30 % of the measured range.
void predict(const Experiment& e) {
  const auto [least, most] = std::minmax_element(
      e.rows.begin(), e.rows.end(), [](const Row& a, const Row& b) { return a.pull < b.pull; });
  const double range = std::max({most->pull, e.rolling.pull, e.slipping.pull}) -
                       std::min({least->pull, e.rolling.pull, e.slipping.pull});
  for (const Row& row : e.rows) {
    const WheelForce law = at(e, row);
    char slip[16];
    std::snprintf(slip, sizeof slip, "%g", row.slip);
    validation::expect_between(std::string("slip ") + slip + ", sinkage [mm]", 1000 * law.sinkage,
                               0.7 * row.sinkage, 1.3 * row.sinkage, e.source, row.sinkage);
    validation::expect_between(std::string("slip ") + slip + ", pull [N]", law.drawbar,
                               row.pull - 0.3 * range, row.pull + 0.3 * range, e.source, row.pull);
  }
}

/// Expects the law to carry the wheel at the fitted and the predicted slips of a driven wheel, and
/// its pull within 3 N of the measured one.
void expect_pulls(const Experiment& e) {
  std::vector<Row> driven = {e.rolling, e.slipping};
  std::copy_if(e.rows.begin(), e.rows.end(), std::back_inserter(driven),
               [](const Row& row) { return row.slip > 0; });
  EXPECT_EQ(driven.size(), 5);
  for (const Row& row : driven) {
    const WheelForce law = at(e, row);
    EXPECT_TRUE(law.carried) << "slip " << row.slip;
    EXPECT_NEAR(1000 * law.sinkage, row.sinkage, 0.3 * row.sinkage) << "slip " << row.slip;
    char slip[16];
    std::snprintf(slip, sizeof slip, "%g", row.slip);
    validation::expect_between(std::string("slip ") + slip + ", pull less the measured one [N]",
                               law.drawbar - row.pull, -3, 3, e.source, 0);
  }
}

scene::Soil sand(double phi_degrees, double exponent, double janosi_k) {
  scene::Soil soil;
  // The rim's friction is not published.
  soil.friction_angle = soil.tool_friction_angle = radians(phi_degrees);
  soil.cohesion = soil.residual_cohesion = soil.adhesion = 0;
  soil.bekker_kc = 0, soil.bekker_n = exponent, soil.janosi_k = janosi_k;
  return soil;
}

TEST(WheelLaw, PredictsASmoothWheelInDrySand) {
  Experiment e;
  e.wheel = {0.0625, 0.06, 24.6, 0};
  e.soil = sand(29, 1.34, 0.021);
  e.rolling = {0, 24.6, -1.3, 14.1}, e.slipping = {0.5, 25.3, 1.0, 22.4};
  e.rows = {{-0.5, 23.2, -17.2, 23.3},
            {-0.2, 23.7, -7.3, 14.7},
            {0.23, 24.6, 0.7, 17.5},
            {0.75, 24.0, 0.8, 25.1},
            {0.9, 25.7, 1.5, 25.4}};
  e.source = "robomechanics rig [docs/validation.md, Wheels]";
  fit(e);
  predict(e);
  expect_pulls(e);
}

TEST(WheelLaw, PredictsASmoothWheelInLunarSimulant) {
  Experiment e;
  e.wheel = {0.15735, 0.165, 80, 0};
  e.soil = sand(31.9, 1.1, 0.0114);  // K: middle of 9.7 to 13.1 mm
  e.soil.cohesion = e.soil.residual_cohesion = 250;
  e.rolling = {0, 80, -6.5, 5.0}, e.slipping = {0.3, 80, 15.0, 10.0};
  e.rows = {
      {0.1, 80, 11.0, 5.5}, {0.2, 80, 14.5, 7.5}, {0.4, 80, 15.0, 12.5}, {0.6, 80, 15.0, 17.5}};
  e.source = "[Ding 2011]";
  fit(e);
  predict(e);
}

}  // namespace
}  // namespace navvy::terramechanics
