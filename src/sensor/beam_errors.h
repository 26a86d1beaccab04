// SPDX-License-Identifier: Apache-2.0
// Errors of distances along beams, and the values that stand for no distance.
#pragma once

#include <cmath>
#include <limits>
#include <optional>

#include "sensor/noise.h"
#include "sensor/ray_scene.h"

namespace navvy::sensor {

/// Value of a beam that meets nothing within the range REP 117.
inline constexpr double kTooFar = std::numeric_limits<double>::infinity();
/// Value of a beam that meets something below the range REP 117.
inline constexpr double kTooNear = -std::numeric_limits<double>::infinity();
/// Value of a beam that returns nothing by chance REP 117.
inline constexpr double kDropped = std::numeric_limits<double>::quiet_NaN();

/// Adds the errors of one kind of beam to true distances.
class BeamDisturbance {
 public:
  /// Draws constant errors from `random`. Distances are from `min` to `max` [m] in steps of
  /// `resolution` [m], or not rounded if it is 0.
  BeamDisturbance(const scene::SensorNoise& noise, const scene::BeamErrors& errors, double min,
                  double max, double resolution, Random& random)
      : noise_(noise, random), errors_(errors), min_(min), max_(max), resolution_(resolution) {}

  /// Goes on by `dt` [s]; before the first `apply` of a reading.
  void advance(double dt, Random& random) { noise_.advance(dt, random); }
  /// Returns the reading for a true distance; kTooFar stands for none.
  double apply(double distance, Random& random) const;
  /// Visits the biases.
  void visit(Archive& a) { noise_.visit(a); }

 private:
  Noise noise_;
  scene::BeamErrors errors_;
  double min_, max_, resolution_;
};

/// Returns the distance to the first thing that a beam meets within `reach` [m]; kTooFar if there
/// is none.
inline double distance_along(const RayScene& scene, const Vec3& p_W, const Vec3& direction_W,
                             double reach) {
  const auto hit = scene.first_hit(p_W, direction_W, reach);
  return hit ? hit->distance : kTooFar;
}

}  // namespace navvy::sensor
