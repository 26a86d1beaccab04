// SPDX-License-Identifier: Apache-2.0
// Random errors of measured values.
#pragma once

#include "core/archive.h"
#include "core/random.h"
#include "scene/sensor.h"

namespace navvy::sensor {

/// Returns a normally distributed number with mean 0 and standard deviation 1, by the method of
/// [Box 1958]. Takes two numbers from `random`.
double gaussian(Random& random);

/// Errors of one value, as a scene describes them: a constant bias, a drifting bias, a Gaussian
/// error, and rounding. The random numbers come from the sensor's generator.
class Noise {
 public:
  Noise() = default;
  /// Draws the bias from `random`.
  Noise(const scene::SensorNoise& description, Random& random);

  /// Lets the drifting bias go on by `dt` [s]; at a reading, before `apply`.
  void advance(double dt, Random& random);
  /// Returns `value` with errors.
  double apply(double value, Random& random) const;
  /// Returns the constant and the drifting bias.
  double bias() const { return bias_ + drift_; }
  /// Visits both biases.
  void visit(Archive& a);

 private:
  scene::SensorNoise description_;
  double bias_ = 0;   ///< constant part of the bias, in the unit of the value
  double drift_ = 0;  ///< drifting part of the bias, in the unit of the value
};

}  // namespace navvy::sensor
