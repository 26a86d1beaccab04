// SPDX-License-Identifier: Apache-2.0
#include "scene/soil_values.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iterator>
#include <string>
#include <utility>

namespace navvy::scene {
namespace {

/// Conversion from radians changes the last bits of a bound in degrees.
constexpr double kRounding = 1e-12;

// The element is written as in a scene, so that the loader can find its line.
Fault fault(const Soil& soil, const char* name, double value, const std::string& rule,
            const std::string& remedy) {
  Fault out;
  out.element = "soil[" + soil.name + "]/" + name;
  out.value = short_text(value);
  out.rule = rule;
  out.remedy = remedy;
  return out;
}

// Sand of this stiffness is as strong as stiffer sand [Pa].
constexpr double kSoftest = 1e6;
constexpr double kStiffnessPerCohesion = 200;  ///< default
constexpr double kLooseShare = 0.2;            ///< default loose cohesion / residual cohesion
constexpr double kTooSoft = 100;  ///< stiffness / cohesion below which a warning is due

/// Force / [Rankine 1857] of a smooth blade 0.3 m deep after it has risen, and the travel until
/// then / depth, for soil of phi 30 deg and c 50 kPa in plane strain, cells of 0.1 m, 0.1 m/s.
/// measured: `plane_strain blade phi=30 c=50000 loose=50000 e=... hold=4 crowding=shear
/// opening=seen`, windows of 0.02 m; at ratio 200 it is 1.01.
struct Mobilised {
  double ratio, share, travel;
};
constexpr Mobilised kMobilised[] = {{20, 0.63, 0.37}, {50, 0.86, 0.30}, {100, 0.95, 0.30}};

}  // namespace

std::vector<SoilValue> soil_values(Soil& soil) {
  std::vector<SoilValue> all = numbers_of([&soil](Fields& f) { soil.describe(f); });
  std::erase_if(all, [](const SoilValue& value) { return !value.parameter; });
  return all;
}

double default_stiffness(double cohesion) {
  return std::max(kSoftest, kStiffnessPerCohesion * cohesion);
}

void follow_cohesion(Soil& soil, double before) {
  if (soil.young_modulus == default_stiffness(before))
    soil.young_modulus = default_stiffness(soil.cohesion);
}

double default_loose_cohesion(double residual) { return kLooseShare * residual; }

void follow_residual_cohesion(Soil& soil, double before) {
  if (soil.loose_cohesion == default_loose_cohesion(before))
    soil.loose_cohesion = default_loose_cohesion(soil.residual_cohesion);
}

std::optional<Fault> follow_friction_test(Soil& soil) {
  if (soil.friction_test == FrictionTest::kPlaneStrain) return std::nullopt;
  auto refused =
      check_friction(soil.friction_test, soil.tested_friction_angle, soil.dilatancy_angle);
  if (!refused)
    soil.friction_angle =
        plane_strain_angle(soil.friction_test, soil.tested_friction_angle, soil.dilatancy_angle);
  return refused;
}

std::optional<Fault> too_soft(const Soil& soil) {
  const double ratio = soil.young_modulus / soil.cohesion;
  if (!(soil.cohesion > 0) || !(ratio < kTooSoft)) return std::nullopt;
  // Interpolates by the logarithm of the ratio; below the first row the share is smaller.
  std::size_t row = 1;
  while (row + 1 < std::size(kMobilised) && ratio > kMobilised[row].ratio) ++row;
  const Mobilised &low = kMobilised[row - 1], &high = kMobilised[row];
  const double part =
      std::clamp(std::log(ratio / low.ratio) / std::log(high.ratio / low.ratio), 0.0, 1.0);
  const double share = low.share + part * (high.share - low.share),
               travel = low.travel + part * (high.travel - low.travel);
  char rule[200], remedy[200];
  std::snprintf(rule, sizeof rule,
                "is %.0f times the cohesion: a blade feels %s %.0f %% of the soil's strength, "
                "after %.2f of its depth",
                ratio, ratio < low.ratio ? "less than" : "about", 100 * share, travel);
  const double wanted = default_stiffness(soil.cohesion);
  std::snprintf(remedy, sizeof remedy,
                "remove it: %.3g, 200 times the cohesion, takes %.1f times as many steps", wanted,
                std::sqrt(wanted / soil.young_modulus));
  Fault out = fault(soil, "young_modulus_pa", soil.young_modulus, rule, remedy);
  out.severity = Fault::Severity::kWarning;
  return out;
}

std::vector<Fault> check_relations(const Soil& soil) {
  std::vector<Fault> out;
  if (soil.residual_cohesion > soil.cohesion)
    out.push_back(fault(soil, "residual_cohesion_pa", soil.residual_cohesion,
                        "must not exceed cohesion_pa, " + short_text(soil.cohesion),
                        "remoulding only weakens soil"));
  // The comparison refuses NaN.
  if (soil.dilatancy_angle > 0 && !(soil.swell > 1))
    out.push_back(fault(soil, "dilatancy_angle_deg", soil.dilatancy_angle / kDegree,
                        "needs a swell above 1: soil dilates from its bank to its loose density",
                        "give the soil a swell, or no dilatancy"));
  if (soil.dilatancy_angle > soil.friction_angle)
    out.push_back(
        fault(soil, "dilatancy_angle_deg", soil.dilatancy_angle / kDegree,
              "must not exceed friction_angle_deg, " + short_text(soil.friction_angle / kDegree),
              "soil that dilates more than it rubs makes energy"));
  // Below 1 two passes would sink more than twice as deep as one.
  if (soil.multi_pass_exponent != 0 && !(soil.multi_pass_exponent >= 1))
    out.push_back(fault(soil, "multi_pass_exponent", soil.multi_pass_exponent,
                        "must be 0 or at least 1: equal passes sink ever less",
                        "give 1 to 20, or 0 for ground that only the first pass presses"));
  return out;
}

std::vector<Fault> check_soil(const Soil& soil) {
  std::vector<Fault> out;
  Soil copy = soil;
  for (const SoilValue& v : soil_values(copy)) {
    const double value = v.written();
    // The comparison refuses NaN. The slack is relative, as bounds span nine decades.
    const bool ok = value >= v.low - kRounding * std::abs(v.low) &&
                    value <= v.high + kRounding * std::abs(v.high);
    if (!ok)
      out.push_back(
          fault(soil, v.name, value,
                "must be a number from " + short_text(v.low) + " to " + short_text(v.high),
                "correct the soil"));
  }
  for (Fault& fault : check_relations(soil)) out.push_back(std::move(fault));
  return out;
}

}  // namespace navvy::scene
