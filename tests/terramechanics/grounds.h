// SPDX-License-Identifier: Apache-2.0
// Grounds defined by functions, for wheels in tests.
#pragma once

#include <cmath>
#include <functional>
#include <utility>

#include "terramechanics/ground_query.h"

namespace navvy::terramechanics {

/// A surface over x and y [m], with its normal from differences over 0.1 m. A firm floor unless
/// given a soil. Bodies touch it as triangles between nodes `spacing` [m] apart.
class FunctionGround final : public GroundQuery {
 public:
  explicit FunctionGround(std::function<double(double, double)> height, double spacing = 0.2)
      : height_(std::move(height)), spacing_(spacing) {}
  void set_soil(std::function<SoilState(double, double)> soil) { soil_ = std::move(soil); }

  double height(double x, double y) const override { return height_(x, y); }
  Vec3 normal(double x, double y) const override {
    constexpr double kHalf = 0.05;
    const double dx = (height_(x + kHalf, y) - height_(x - kHalf, y)) / (2 * kHalf);
    const double dy = (height_(x, y + kHalf) - height_(x, y - kHalf)) / (2 * kHalf);
    return Vec3(-dx, -dy, 1).normalized();
  }
  GroundLattice lattice() const override { return {Vec2::Zero(), spacing_}; }
  SoilState soil(double x, double y) const override { return soil_ ? soil_(x, y) : SoilState{}; }

 private:
  std::function<double(double, double)> height_;
  double spacing_;
  std::function<SoilState(double, double)> soil_;
};

inline FunctionGround flat() {
  return FunctionGround([](double, double) { return 0.0; });
}
/// Returns a plane that rises along x.
inline FunctionGround slope(double angle) {
  return FunctionGround([t = std::tan(angle)](double x, double) { return t * x; });
}

}  // namespace navvy::terramechanics
