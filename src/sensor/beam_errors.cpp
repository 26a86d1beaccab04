// SPDX-License-Identifier: Apache-2.0
#include "sensor/beam_errors.h"

namespace navvy::sensor {

double BeamDisturbance::apply(double distance, Random& random) const {
  // Without shares no number is drawn, so that the noise of a plain sensor is cheap.
  if (errors_.dropped > 0 && random.uniform() < errors_.dropped) return kDropped;
  if (errors_.outliers > 0 && random.uniform() < errors_.outliers)
    return random.uniform(min_, max_);
  if (!std::isfinite(distance)) return distance;
  // What is too near is so by its true distance: noise does not make it visible.
  if (distance < min_) return kTooNear;
  double out = noise_.apply(distance, random);
  if (resolution_ > 0) out = resolution_ * std::round(out / resolution_);
  return out > max_ ? kTooFar : (out < min_ ? kTooNear : out);
}

}  // namespace navvy::sensor
