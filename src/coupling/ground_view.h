// SPDX-License-Identifier: Apache-2.0
// The heightfield as machines feel it.
#pragma once

#include "heightfield/ground.h"
#include "vehicle/engine.h"

namespace navvy::coupling {

/// Answers the engine's questions from the current columns; costs a bilinear lookup.
class GroundView final : public vehicle::GroundQuery {
 public:
  explicit GroundView(const heightfield::Ground& ground) : ground_(ground) {}
  double height(double x, double y) const override { return ground_.sample(x, y); }
  Vec3 normal(double x, double y) const override { return ground_.normal(x, y); }

 private:
  const heightfield::Ground& ground_;
};

}  // namespace navvy::coupling
