// SPDX-License-Identifier: Apache-2.0
#include "sensor/noise.h"

#include <cmath>

#include "core/math.h"

namespace navvy::sensor {

double gaussian(Random& random) {
  // 1 - u is in (0, 1], so that the logarithm is finite.
  const double radius = std::sqrt(-2 * std::log(1 - random.uniform()));
  return radius * std::cos(2 * kPi * random.uniform());
}

Noise::Noise(const scene::SensorNoise& description, Random& random) : description_(description) {
  if (!description_.active()) return;
  bias_ = description_.bias_mean + description_.bias_stddev * gaussian(random);
  // As in Gazebo, the sign is random, so that `bias_mean` is a magnitude.
  if (random.uniform() < 0.5) bias_ = -bias_;
}

// The Gauss-Markov process whose standard deviation does not depend on the step.
void Noise::advance(double dt, Random& random) {
  if (!description_.active() || !(description_.drift_time > 0)) return;
  const double keep = std::exp(-dt / description_.drift_time);
  drift_ =
      keep * drift_ + description_.drift_stddev * std::sqrt(1 - keep * keep) * gaussian(random);
}

double Noise::apply(double value, Random& random) const {
  if (!description_.active()) return value;
  value += description_.mean + bias_ + drift_;
  if (description_.stddev > 0) value += description_.stddev * gaussian(random);
  const double step = description_.precision;
  return step > 0 ? step * std::round(value / step) : value;
}

void Noise::visit(Archive& a) {
  a("bias", bias_);
  a("drift", drift_);
}

}  // namespace navvy::sensor
