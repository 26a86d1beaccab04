// SPDX-License-Identifier: Apache-2.0
// The heightfield as machines feel it.
#pragma once

#include "heightfield/terrain.h"
#include "vehicle/engine.h"

namespace navvy::coupling {

/// Answers the engine's questions from the terrain it is given: the live ground means the columns of this very step,
/// without loose soil. Costs a bilinear lookup.
class GroundView final : public vehicle::GroundQuery {
 public:
  explicit GroundView(const heightfield::Terrain& terrain) : terrain_(terrain) {}
  double height(double x, double y) const override { return terrain_.sample(x, y); }
  Vec3 normal(double x, double y) const override { return terrain_.normal(x, y); }

 private:
  const heightfield::Terrain& terrain_;
};

}  // namespace navvy::coupling
