// SPDX-License-Identifier: Apache-2.0
// The heightfield as machines feel it.
#pragma once

#include <algorithm>

#include "heightfield/ground.h"
#include "terramechanics/ground_query.h"

namespace navvy::coupling {

/// Answers what wheels and bodies ask from the columns as they are now. Loose particles are not there for it.
///
/// Height and normal are bilinear between column centres, soil and density state are those of the top layer of the
/// column that holds the place; outside the site the nearest column answers. A call costs a lookup, no allocation. The
/// ground must outlive the view.
class GroundView final : public terramechanics::GroundQuery {
 public:
  explicit GroundView(const heightfield::Ground& ground) : ground_(ground) {}
  double height(double x, double y) const override { return ground_.sample(x, y); }
  Vec3 normal(double x, double y) const override { return ground_.normal(x, y); }
  terramechanics::SoilState soil(double x, double y) const override {
    const Vec2i c = ground_.column_at(x, y);
    const int ix = std::clamp(c.x(), 0, ground_.nx() - 1), iy = std::clamp(c.y(), 0, ground_.ny() - 1);
    return {&ground_.setup().soils[ground_.surface_soil(ix, iy)], ground_.surface_volume_ratio(ix, iy)};
  }

 private:
  const heightfield::Ground& ground_;
};

}  // namespace navvy::coupling
