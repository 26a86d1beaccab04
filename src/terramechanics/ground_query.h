// SPDX-License-Identifier: Apache-2.0
// Interface through which wheels, tracks and bodies read the ground. `coupling` implements it over
// its columns, tests by a formula.
#pragma once

#include <limits>

#include "core/math.h"
#include "scene/soil.h"

namespace navvy::terramechanics {

/// Soil at the surface of one place and its density. Without a soil the place is a firm floor: a
/// slab, a plate, a plane of a test.
///
/// `soil` belongs to the ground that returned it and lives as long as the ground.
struct SoilState {
  const scene::Soil* soil = nullptr;
  /// Ratio volume / bank volume [-]: 1 in bank state, up to the soil's swell when loose, below 1
  /// when compacted.
  double volume_ratio = 1;

  /// Returns the density [kg/m3]; 0 on a firm floor.
  double density() const { return soil != nullptr ? soil->bank_density / volume_ratio : 0; }
};

/// Compaction of the ground since the tyre that stands on it arrived. A rolling tyre repeats it on
/// every new square metre. Zero where the ground already bore as much.
struct Sinkage {
  /// Work per area [J/m2].
  double work = 0;
  double depth = 0;  ///< [m]
};

/// State of the ground at one place.
struct GroundState {
  /// Height of the surface in W [m].
  double height = 0;
  /// Unit upward normal in W.
  Vec3 normal = Vec3::UnitZ();
  SoilState soil;
};

/// Grid nodes of a ground: `node` plus whole multiples of `spacing` [m].
struct GroundLattice {
  Vec2 node = Vec2::Zero();
  double spacing = 0.1;
};

/// Answers questions about the ground. Places are x and y in W [m]. A ground answers with its
/// nearest place outside its extent.
///
/// A wheel reads height and normal some hundred times per step and the soil a few times, so each
/// has a function of its own.
class GroundQuery {
 public:
  virtual ~GroundQuery() = default;

  /// Returns the height of the surface in W [m].
  virtual double height(double x, double y) const = 0;
  /// Returns an upper bound of the heights in the rectangle from `low` to `high` in W [m]; infinite
  /// by default.
  virtual double highest(const Vec2& low, const Vec2& high) const {
    (void)low, (void)high;
    return std::numeric_limits<double>::infinity();
  }
  /// Returns the unit upward normal of the surface.
  virtual Vec3 normal(double x, double y) const = 0;
  /// Returns soil and density at the surface; a firm floor by default.
  virtual SoilState soil(double x, double y) const {
    (void)x, (void)y;
    return {};
  }

  /// Returns the compaction here since the tyre that stands on it arrived; zero by default.
  virtual Sinkage sinking(double x, double y) const {
    (void)x, (void)y;
    return {};
  }

  /// Returns the grid on which heights are given. Rigid bodies meet flat triangles between its
  /// nodes.
  virtual GroundLattice lattice() const { return {}; }

  /// Returns height, normal and soil.
  GroundState at(double x, double y) const { return {height(x, y), normal(x, y), soil(x, y)}; }
};

}  // namespace navvy::terramechanics
