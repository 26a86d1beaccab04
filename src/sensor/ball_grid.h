// SPDX-License-Identifier: Apache-2.0
// A uniform grid over balls, for beams.
#pragma once

#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "core/math.h"
#include "sim/visible_soil.h"

namespace navvy::sensor {

/// Balls sorted into the cells of a uniform grid, with edges of at least four radii.
///
/// Building sorts the balls by the cells of their centres, in two passes. The list of all balls
/// that reach into a cell is made when a beam first enters the cell: a scan enters few of them. Not
/// thread-safe.
class BallGrid {
 public:
  /// Replaces the balls. `balls` count from `origin` in W [m].
  void build(const Vec3& origin, const std::vector<sim::SoilBall>& balls);
  /// Returns the distance to the first ball within `reach` [m] that the beam from `p_W` along the
  /// unit vector `direction_W` meets; 0 inside a ball.
  std::optional<double> first_hit(const Vec3& p_W, const Vec3& direction_W, double reach) const;

 private:
  /// Returns the index of the cell with these coordinates.
  std::size_t index(const Eigen::Vector3i& cell) const {
    return static_cast<std::size_t>(cell.x()) +
           static_cast<std::size_t>(size_.x()) *
               (static_cast<std::size_t>(cell.y()) +
                static_cast<std::size_t>(size_.y()) * static_cast<std::size_t>(cell.z()));
  }
  /// Returns the cell that contains a point relative to `low_`, at most the outermost one.
  Eigen::Vector3i cell_at(const Vec3& p) const;

  /// Returns the range in `reaching_` of the balls that reach into a cell.
  std::pair<std::uint32_t, std::uint32_t> reaching(const Eigen::Vector3i& cell) const;

  Vec3 origin_ = Vec3::Zero();         ///< point in W that balls count from [m]
  Vec3 low_ = Vec3::Zero();            ///< lowest corner of the grid, relative to `origin_` [m]
  Vec3 high_ = Vec3::Zero();           ///< highest corner, relative to `origin_` [m]
  double edge_ = 1;                    ///< edge of a cell [m]
  Eigen::Vector3i size_{0, 0, 0};      ///< number of cells along each axis
  std::vector<std::uint32_t> cell_;    ///< cell of the centre of each ball, while building
  std::vector<std::uint32_t> start_;   ///< first entry of each cell in `sorted_`, and the end
  std::vector<sim::SoilBall> sorted_;  ///< balls by the cells of their centres
  /// Range in `reaching_` of each cell that a beam has entered; (1, 0): none has.
  mutable std::vector<std::pair<std::uint32_t, std::uint32_t>> ranges_;
  mutable std::vector<sim::SoilBall> reaching_;  ///< balls that reach into the entered cells
};

}  // namespace navvy::sensor
