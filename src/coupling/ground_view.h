// SPDX-License-Identifier: Apache-2.0
// The heightfield as machines read it.
#pragma once

#include <algorithm>
#include <vector>

#include "coupling/ruts.h"
#include "heightfield/terrain.h"
#include "scene/soil.h"
#include "terramechanics/ground_query.h"

namespace navvy::coupling {

/// Answers the questions of wheels and bodies from a terrain. For the live ground these are the
/// columns of the current step, without loose soil. With `ruts` it also reports the compaction
/// under tyres.
///
/// Height and normal are bilinear between column centres. Soil and density are those at the surface
/// of the column that contains the place. Outside the site the nearest column answers. A call costs
/// a look-up and allocates nothing. Terrain, soils and ruts must outlive the view.
class GroundView final : public terramechanics::GroundQuery {
 public:
  /// Wraps `terrain`. Its soil indices refer to `soils`.
  GroundView(const heightfield::Terrain& terrain, const std::vector<scene::Soil>& soils,
             const Ruts* ruts = nullptr)
      : terrain_(terrain), soils_(soils), ruts_(ruts) {}
  double height(double x, double y) const override { return terrain_.sample(x, y); }
  double highest(const Vec2& low, const Vec2& high) const override {
    // Heights between column centres are bounded by the surrounding columns.
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
