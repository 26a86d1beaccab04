// SPDX-License-Identifier: Apache-2.0
// A path for a machine to drive: a sequence of arcs and straight lines, driven forwards or
// backwards. The machine stops wherever the direction of travel changes.
#pragma once

#include <cstdint>
#include <vector>

#include "control/pursuit.h"
#include "core/archive.h"

namespace navvy::control {

/// One segment of a path: an arc, or a straight line if its curvature is zero.
struct PathPiece {
  /// Length [m]; negative if the segment is driven backwards.
  double length = 0;
  /// Curvature [1/m]: the change of heading per metre driven forwards, positive for a left turn.
  double curvature = 0;

  /// Saves or loads the segment. Loading rejects values that no path on a site can have.
  void visit(Archive& a) {
    // Bounds of any path on a site; walking along a longer one would not end.
    a.ranged("length", length, -1e5, 1e5);
    a.ranged("curvature", curvature, -1e3, 1e3);
  }
};

/// A part of a path that is driven in one direction, from one stop to the next.
struct PathLeg {
  /// Distances driven since the start of the path at which the leg begins and ends [m].
  double begin = 0, end = 0;
  /// Direction of travel: 1 forwards, -1 backwards.
  double sense = 1;
};

/// A sequence of path segments that starts at a given pose of the middle of the rear axle.
///
/// A position on the path is given by `s` [m], the distance driven since the start. It grows in
/// both directions of travel. Poses are computed in closed form, so they are exact to rounding at
/// any distance.
class Path {
 public:
  /// Makes an empty path of length 0 that starts at the origin of W.
  Path() = default;
  /// Makes a path from its start pose and its segments.
  Path(const PlanePose& start, std::vector<PathPiece> pieces);

  /// Returns the pose at s = 0.
  const PlanePose& start() const { return start_; }
  /// Returns the segments in the order in which they are driven.
  const std::vector<PathPiece>& pieces() const { return pieces_; }
  /// Returns the legs in driving order. Two consecutive legs are driven in opposite directions and
  /// meet at a cusp. Empty if the path has length 0.
  const std::vector<PathLeg>& legs() const { return legs_; }
  /// Returns the number of changes of direction.
  int cusps() const { return legs_.empty() ? 0 : static_cast<int>(legs_.size()) - 1; }
  /// Returns the distance driven from start to end [m].
  double length() const { return legs_.empty() ? 0 : legs_.back().end; }
  /// Returns the pose of the machine after driving the distance `s` [m]; `s` is clamped to the
  /// path.
  PlanePose at(double s) const;
  /// Returns the mean curvature [1/m] of the path between `s - half` and `s + half` [m]. The
  /// interval is clamped to `leg`; if it has no length, the curvature at that point is returned.
  double curvature(const PathLeg& leg, double s, double half) const;

  /// Saves or loads the start pose and the segments. Loading recomputes the legs.
  void visit(Archive& a);

 private:
  /// Computes `legs_` from `pieces_`.
  void find_legs();

  // Pose at s = 0.
  PlanePose start_;
  // Segments in the order in which they are driven.
  std::vector<PathPiece> pieces_;
  // Legs in driving order, computed from the segments.
  std::vector<PathLeg> legs_;
};

/// A path that was planned for a step of a program. The operator stores it to show where the
/// machine was meant to drive.
struct PlannedPath {
  /// Position of the step in the program, counted from 1.
  std::int64_t step = 0;
  /// Simulated time at which the path was planned [s].
  double time = 0;
  /// The planned path.
  Path path;

  /// Saves or loads all fields.
  void visit(Archive& a) {
    a("step", step);
    a("time", time);
    a("path", path);
  }
};

}  // namespace navvy::control
