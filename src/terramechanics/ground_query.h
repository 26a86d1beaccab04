// SPDX-License-Identifier: Apache-2.0
// Interface through which wheels, tracks and rigid bodies read the ground. The `coupling` module
// implements it with its column map; tests implement it with a formula.
#pragma once

#include <limits>

#include "core/math.h"
#include "scene/soil.h"

namespace navvy::terramechanics {

/// Soil at the surface at one point of the ground, and how loose or compacted it is.
///
/// A null `soil` means a firm floor, for example a slab, a steel plate or a test's plane. The
/// pointer belongs to the ground that returned it and is valid as long as that ground exists.
struct SoilState {
  /// Soil at the surface; null on a firm floor.
  const scene::Soil* soil = nullptr;
  /// Volume of the soil divided by its volume in bank state [-]: 1 in bank state, up to the soil's
  /// swell when loose, below 1 when compacted.
  double volume_ratio = 1;

  /// Returns the bulk density of the soil [kg/m3]; 0 on a firm floor.
  double density() const { return soil != nullptr ? soil->bank_density / volume_ratio : 0; }
};

/// Compaction of the ground under a standing or rolling tyre, counted from the moment at which the
/// tyre arrived at that point. Both values are 0 where the ground had already been compacted by an
/// equal or larger pressure.
struct Sinkage {
  /// Work of compaction per unit of ground area [J/m2].
  double work = 0;
  /// Depth by which the compaction lowered the surface [m].
  double depth = 0;
};

/// Height, normal and soil of the ground at one point.
struct GroundState {
  /// Height of the surface in the world frame [m].
  double height = 0;
  /// Unit normal of the surface in the world frame, pointing up.
  Vec3 normal = Vec3::UnitZ();
  /// Soil at the surface and its volume ratio.
  SoilState soil;
};

/// Square grid on which a ground defines its heights.
struct GroundLattice {
  /// Position x, y of one grid node in the world frame [m]. The other nodes are at whole multiples
  /// of `spacing` from it.
  Vec2 node = Vec2::Zero();
  /// Distance between neighbouring nodes along x and along y [m].
  double spacing = 0.1;
};

/// Read access to the ground under wheels, tracks and rigid bodies.
///
/// Every query takes a horizontal position x, y in the world frame [m]. Outside its extent, a
/// ground returns the values of its nearest point.
///
/// A wheel reads heights and normals about a hundred times per step but the soil only a few times,
/// so each quantity has its own function.
class GroundQuery {
 public:
  /// Destroys the ground through this interface.
  virtual ~GroundQuery() = default;

  /// Returns the height of the surface at x, y in the world frame [m].
  virtual double height(double x, double y) const = 0;
  /// Returns an upper bound in the world frame [m] of all surface heights in the rectangle with the
  /// corners `low` and `high` [m]. Callers use it to skip bodies that are well above the ground.
  /// The default implementation returns infinity, which skips nothing.
  virtual double highest(const Vec2& low, const Vec2& high) const {
    (void)low, (void)high;
    return std::numeric_limits<double>::infinity();
  }
  /// Returns the unit normal of the surface at x, y in the world frame, pointing up.
  virtual Vec3 normal(double x, double y) const = 0;
  /// Returns the soil at the surface at x, y and its volume ratio. The default implementation
  /// returns a firm floor.
  virtual SoilState soil(double x, double y) const {
    (void)x, (void)y;
    return {};
  }

  /// Returns by how much the ground at x, y has been compacted since the tyre that now stands there
  /// arrived. The default implementation returns zero, for ground that does not compact.
  virtual Sinkage sinking(double x, double y) const {
    (void)x, (void)y;
    return {};
  }

  /// Returns the grid on which the heights are defined. Rigid bodies collide with flat triangles
  /// between the nodes of this grid.
  virtual GroundLattice lattice() const { return {}; }

  /// Returns height, normal and soil at x, y [m] together.
  GroundState at(double x, double y) const { return {height(x, y), normal(x, y), soil(x, y)}; }
};

}  // namespace navvy::terramechanics
