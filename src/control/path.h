// SPDX-License-Identifier: Apache-2.0
// A way to drive: arcs and straight lines, forwards and backwards, with a stop wherever the
// direction changes.
#pragma once

#include <cstdint>
#include <vector>

#include "control/pursuit.h"
#include "core/archive.h"

namespace navvy::control {

/// An arc, or a straight line where the curvature is zero.
struct PathPiece {
  double length = 0;     ///< [m]; negative: driven backwards
  double curvature = 0;  ///< [1/m], positive to the machine's left

  void visit(Archive& a) {
    // What is longer is no path of a site; a walk along it would not end.
    a.ranged("length", length, -1e5, 1e5);
    a.ranged("curvature", curvature, -1e3, 1e3);
  }
};

/// A stretch in one direction: from a stand to the next stand.
struct PathLeg {
  double begin = 0, end = 0;  ///< along the path [m]
  double sense = 1;           ///< 1 forwards, -1 backwards
};

/// Pieces one after the other, from a pose of the middle of the rear axle. Places on it are told by
/// the length driven since the start, s [m], which grows backwards too. Poses are closed forms:
/// exact to rounding, whatever the length.
class Path {
 public:
  Path() = default;
  Path(const PlanePose& start, std::vector<PathPiece> pieces);

  const PlanePose& start() const { return start_; }
  const std::vector<PathPiece>& pieces() const { return pieces_; }
  /// At least one where the path has any length; a change of direction (a cusp) lies between two of
  /// them.
  const std::vector<PathLeg>& legs() const { return legs_; }
  int cusps() const { return legs_.empty() ? 0 : static_cast<int>(legs_.size()) - 1; }
  double length() const { return legs_.empty() ? 0 : legs_.back().end; }
  /// The machine at s, which is cut to the path's length.
  PlanePose at(double s) const;
  /// Mean curvature [1/m] from s - half to s + half, cut to the leg.
  double curvature(const PathLeg& leg, double s, double half) const;

  void visit(Archive& a);

 private:
  void find_legs();

  PlanePose start_;
  std::vector<PathPiece> pieces_;
  // Follows from the pieces.
  std::vector<PathLeg> legs_;
};

/// A path of a program, as its operator keeps it for who wants to see where the machine meant to
/// go.
struct PlannedPath {
  std::int64_t step = 0;  ///< of the program, the first is 1
  double time = 0;        ///< when it was planned, simulated [s]
  Path path;

  void visit(Archive& a) {
    a("step", step);
    a("time", time);
    a("path", path);
  }
};

}  // namespace navvy::control
