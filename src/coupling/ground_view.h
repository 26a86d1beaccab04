// SPDX-License-Identifier: Apache-2.0
// The heightfield as machines feel it.
#pragma once

#include <algorithm>
#include <vector>

#include "coupling/ruts.h"
#include "heightfield/terrain.h"
#include "scene/soil.h"
#include "terramechanics/ground_query.h"

namespace navvy::coupling {

/// Answers what wheels and bodies ask from the terrain it is given: the live ground means the
/// columns of this very step, without loose soil. Of ruts it tells what they take, where it is
/// given those who press them.
///
/// Height and normal are bilinear between column centres, soil and density state are those at the
/// surface of the column that holds the place; outside the site the nearest column answers. A call
/// costs a lookup, no allocation. Terrain, soils and ruts must outlive the view.
class GroundView final : public terramechanics::GroundQuery {
 public:
  /// `soils` are those that the terrain's soil indices count.
  GroundView(const heightfield::Terrain& terrain, const std::vector<scene::Soil>& soils,
             const Ruts* ruts = nullptr)
      : terrain_(terrain), soils_(soils), ruts_(ruts) {}
  double height(double x, double y) const override { return terrain_.sample(x, y); }
  double highest(const Vec2& low, const Vec2& high) const override {
    // Between column centres heights are those of the columns around.
    const Vec2i first = terrain_.column_at(low.x(), low.y()),
                last = terrain_.column_at(high.x(), high.y());
    return terrain_.highest({first.x() - 1, first.y() - 1, last.x() + 2, last.y() + 2});
  }
  Vec3 normal(double x, double y) const override { return terrain_.normal(x, y); }
  terramechanics::GroundLattice lattice() const override {
    return {terrain_.origin() + Vec2::Constant(0.5 * terrain_.cell()), terrain_.cell()};
  }
  terramechanics::Sinkage sinking(double x, double y) const override {
    return ruts_ != nullptr ? ruts_->sinking(x, y) : terramechanics::Sinkage{};
  }
  terramechanics::SoilState soil(double x, double y) const override {
    const Vec2i c = terrain_.column_at(x, y);
    const int ix = std::clamp(c.x(), 0, terrain_.nx() - 1),
              iy = std::clamp(c.y(), 0, terrain_.ny() - 1);
    return {&soils_[terrain_.surface_soil(ix, iy)], terrain_.specific_volume(ix, iy)};
  }

 private:
  const heightfield::Terrain& terrain_;
  const std::vector<scene::Soil>& soils_;
  const Ruts* ruts_;
};

}  // namespace navvy::coupling
