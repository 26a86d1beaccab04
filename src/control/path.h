// SPDX-License-Identifier: Apache-2.0
// A path to drive: arcs and straight lines, forwards and backwards, with a stop at every change of
// direction.
#pragma once

#include <cstdint>
#include <vector>

#include "control/pursuit.h"
#include "core/archive.h"

namespace navvy::control {

/// An arc, or a straight line where the curvature is zero.
struct PathPiece {
  /// Length [m]; negative: driven backwards.
  double length = 0;
  /// Curvature [1/m], positive to the machine's left.
  double curvature = 0;

  void visit(Archive& a) {
    // Bounds of any path on a site; walking along a longer one would not end.
    a.ranged("length", length, -1e5, 1e5);
    a.ranged("curvature", curvature, -1e3, 1e3);
  }
};

/// A part of a path driven in one direction, from one stop to the next.
struct PathLeg {
  /// Start and end along the path [m].
  double begin = 0, end = 0;
  /// 1 forwards, -1 backwards.
  double sense = 1;
};

/// Pieces one after the other, starting from a pose of the middle of the rear axle. Positions on
/// the path are given by the distance driven since the start, s [m], which also grows when driving
/// backwards. Poses are closed forms, exact to rounding at any length.
class Path {
 public:
  Path() = default;
  /// Builds a path from its start pose and pieces.
  Path(const PlanePose& start, std::vector<PathPiece> pieces);

  const PlanePose& start() const { return start_; }
  const std::vector<PathPiece>& pieces() const { return pieces_; }
  /// Returns the legs, at least one where the path has any length. A change of direction (a cusp)
  /// separates two of them.
  const std::vector<PathLeg>& legs() const { return legs_; }
  int cusps() const { return legs_.empty() ? 0 : static_cast<int>(legs_.size()) - 1; }
  double length() const { return legs_.empty() ? 0 : legs_.back().end; }
  /// Returns the machine's pose at s, clamped to the path.
  PlanePose at(double s) const;
  /// Returns the mean curvature [1/m] from s - half to s + half, clamped to the leg.
  double curvature(const PathLeg& leg, double s, double half) const;

  void visit(Archive& a);

 private:
  void find_legs();

  PlanePose start_;
  std::vector<PathPiece> pieces_;
  // Derived from the pieces.
  std::vector<PathLeg> legs_;
};

/// A planned path of a program, which its operator stores to show where the machine meant to drive.
struct PlannedPath {
  /// Number of the program's step, 1-based.
  std::int64_t step = 0;
  /// Simulated time at which it was planned [s].
  double time = 0;
  Path path;

  void visit(Archive& a) {
    a("step", step);
    a("time", time);
    a("path", path);
  }
};

}  // namespace navvy::control
