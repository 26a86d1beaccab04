// SPDX-License-Identifier: Apache-2.0
#include "control/activities/dig/trim.h"

#include <algorithm>

namespace navvy::control {
namespace {

// Rates at which the bucket opens, so that cohesive soil does not leave it in one piece, and closes
// [rad/s]. Opened so far, all falls [rad].
constexpr double kOpens = 0.25, kCloses = 1.2, kMost = 1.8;
// Soil goes on falling so long after the bucket begins to close, at the rate of the last moments:
// of this time [s]. tuned: loam leaves the bucket at 300 to 400 kg/s.
constexpr double kAfter = 0.45, kMoments = 0.1;

}  // namespace

bool Trim::advance(double payload, double most, double dt) {
  if (opening_ > 0) loss_ += ((before_ - payload) / dt - loss_) * std::min(1.0, dt / kMoments);
  before_ = payload;
  if (closing_ || payload - kAfter * loss_ <= most || opening_ >= kMost) {
    closing_ = closing_ || opening_ > 0;
    opening_ = std::max(0.0, opening_ - kCloses * dt);
  } else {
    opening_ += kOpens * dt;
  }
  return opening_ > 0;
}

void Trim::visit(Archive& a) {
  a("opening", opening_);
  a("closing", closing_);
  a("before", before_);
  a("loss", loss_);
}

}  // namespace navvy::control
