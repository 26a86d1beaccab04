// SPDX-License-Identifier: Apache-2.0
// The ground as the wheels and bodies of machines read it.
#pragma once

#include <algorithm>
#include <vector>

#include "coupling/ruts.h"
#include "heightfield/terrain.h"
#include "scene/soil.h"
#include "terramechanics/ground_query.h"

namespace navvy::coupling {

/// Provides the height, normal, soil and compaction of a terrain to wheels and bodies. For the
/// ground of a running world these are the columns at the start of the step, without loose soil.
///
/// Height and normal are interpolated bilinearly between the centres of columns. Soil and density
/// are those at the surface of the column that contains the point. Outside the site, the values of
/// the nearest column apply. Calls allocate no memory.
class GroundView final : public terramechanics::GroundQuery {
 public:
  /// Makes a view of `terrain`. The terrain's soil indices refer to `soils`. If `ruts` is not null,
  /// the view also reports the compaction under tyres. All three must outlive the view.
  GroundView(const heightfield::Terrain& terrain, const std::vector<scene::Soil>& soils,
             const Ruts* ruts = nullptr)
      : terrain_(terrain), soils_(soils), ruts_(ruts) {}
  /// Returns the height in W [m] at the point (x, y) in W [m].
  double height(double x, double y) const override { return terrain_.sample(x, y); }
  /// Returns an upper bound of the height in W [m] in the rectangle from `low` to `high` (x, y in W
  /// [m]).
  double highest(const Vec2& low, const Vec2& high) const override {
    // Heights between column centres are bounded by the surrounding columns.
    const Vec2i first = terrain_.column_at(low.x(), low.y()),
                last = terrain_.column_at(high.x(), high.y());
    return terrain_.highest({first.x() - 1, first.y() - 1, last.x() + 2, last.y() + 2});
  }
  /// Returns the upward unit normal in W at the point (x, y) in W [m].
  Vec3 normal(double x, double y) const override { return terrain_.normal(x, y); }
  /// Returns the lattice of the column centres, between which heights are interpolated.
  terramechanics::GroundLattice lattice() const override {
    return {terrain_.origin() + Vec2::Constant(0.5 * terrain_.cell()), terrain_.cell()};
  }
  /// Returns the compaction at the point (x, y) in W [m] since the tyre that stands there arrived;
  /// zero without a tyre or without ruts.
  terramechanics::Sinkage sinking(double x, double y) const override {
    return ruts_ != nullptr ? ruts_->sinking(x, y) : terramechanics::Sinkage{};
  }
  /// Returns the soil and its specific volume at the surface of the column that contains the point
  /// (x, y) in W [m].
  terramechanics::SoilState soil(double x, double y) const override {
    const Vec2i c = terrain_.column_at(x, y);
    const int ix = std::clamp(c.x(), 0, terrain_.nx() - 1),
              iy = std::clamp(c.y(), 0, terrain_.ny() - 1);
    return {&soils_[terrain_.surface_soil(ix, iy)], terrain_.specific_volume(ix, iy)};
  }

 private:
  // Terrain that is read.
  const heightfield::Terrain& terrain_;
  // Soils to which the terrain's soil indices refer.
  const std::vector<scene::Soil>& soils_;
  // Source of the compaction under tyres; may be null.
  const Ruts* ruts_;
};

}  // namespace navvy::coupling
