// SPDX-License-Identifier: Apache-2.0
// The surface an operator looks at.
#pragma once

#include "heightfield/ground.h"

namespace navvy::control {

/// Height of what can be seen from the cab [m] in W: resting ground, and loose soil on it when the view knows it.
///
/// An interface, as loose soil belongs to a module above this one; asked often, so it should be cheap.
class SurfaceView {
 public:
  virtual ~SurfaceView() = default;
  /// At W (x, y) [m]; beyond the site that of its edge.
  virtual double height(double x, double y) const = 0;
};

/// The resting ground alone.
class GroundSurface final : public SurfaceView {
 public:
  explicit GroundSurface(const heightfield::Ground& ground) : ground_(ground) {}
  double height(double x, double y) const override { return ground_.sample(x, y); }

 private:
  const heightfield::Ground& ground_;
};

}  // namespace navvy::control
