// SPDX-License-Identifier: Apache-2.0
#include "sim/timing.h"

#include <algorithm>
#include <cmath>

namespace navvy::sim {
namespace {

// Quotients of times are rounded: this close counts as a whole number.
constexpr double kHair = 1e-9;

}  // namespace

double base_step(double longest, double period) {
  if (!(period > 0)) return longest;
  return period / std::max(1.0, std::ceil(period / longest - kHair));
}

std::uint64_t samples_through(std::uint64_t step, double dt, double rate) {
  // Half a step further on, the next step becomes the nearer one. Use products, since a sum of
  // periods would drift.
  return static_cast<std::uint64_t>(
      std::ceil((static_cast<double>(step) + 0.5) * (dt * rate) - kHair));
}

std::uint64_t sample_number(std::uint64_t step, double dt, double rate) {
  return step == 0 ? 0 : samples_through(step - 1, dt, rate);
}

bool sample_due(std::uint64_t step, double dt, double rate) {
  return samples_through(step, dt, rate) > sample_number(step, dt, rate);
}

}  // namespace navvy::sim
