// SPDX-License-Identifier: Apache-2.0
// What a wheel, a track or a body asks of the ground under it. Who owns the ground answers:
// coupling from its columns, a test from a formula.
#pragma once

#include <limits>

#include "core/math.h"
#include "scene/soil.h"

namespace navvy::terramechanics {

/// The soil on the surface at one place and how dense it lies there. Without a soil the place is a
/// firm floor: a slab, a plate, a plane of a test.
///
/// `soil` belongs to the ground that answered and lives as long as it does.
struct SoilState {
  const scene::Soil* soil = nullptr;
  /// Volume / bank volume [-]: 1 bank, up to the soil's swell when loose, below 1 pressed.
  double volume_ratio = 1;

  /// [kg/m3]; 0 on a firm floor.
  double density() const { return soil != nullptr ? soil->bank_density / volume_ratio : 0; }
};

/// How far a tyre has pressed the ground since it came there. Rolling on, it does that again on
/// each new square metre; nothing where the ground bore as much before.
struct Sinkage {
  double work = 0;   ///< [J/m2]
  double depth = 0;  ///< [m]
};

/// All of one place at once.
struct GroundState {
  double height = 0;            ///< of the surface in W [m]
  Vec3 normal = Vec3::UnitZ();  ///< unit, upward, in W
  SoilState soil;
};

/// Nodes between which a ground is told exactly: those at `node` plus whole multiples of `spacing`
/// [m].
struct GroundLattice {
  Vec2 node = Vec2::Zero();
  double spacing = 0.1;
};

/// The question itself. Places are W's x and y [m]; outside its extent a ground answers with its
/// nearest place.
///
/// Height and normal are asked some hundred times a wheel and step, the soil a few times, so each
/// has a call of its own.
class GroundQuery {
 public:
  virtual ~GroundQuery() = default;

  /// Of the surface in W [m].
  virtual double height(double x, double y) const = 0;
  /// Not below any height in the rectangle from `low` to `high` in W [m]; infinite where the ground
  /// does not know.
  virtual double highest(const Vec2& low, const Vec2& high) const {
    (void)low, (void)high;
    return std::numeric_limits<double>::infinity();
  }
  /// Unit upward normal of the surface.
  virtual Vec3 normal(double x, double y) const = 0;
  /// Soil and density state on the surface; a firm floor unless the ground knows better.
  virtual SoilState soil(double x, double y) const {
    (void)x, (void)y;
    return {};
  }

  /// What sinking took here since the tyre that stands on it came.
  virtual Sinkage sinking(double x, double y) const {
    (void)x, (void)y;
    return {};
  }

  /// Where its heights are given; between them rigid bodies meet flat triangles.
  virtual GroundLattice lattice() const { return {}; }

  /// All three.
  GroundState at(double x, double y) const { return {height(x, y), normal(x, y), soil(x, y)}; }
};

}  // namespace navvy::terramechanics
