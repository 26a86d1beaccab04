// SPDX-License-Identifier: Apache-2.0
// Plans the next scoop: slice by slice, from the far end to the near one.
#pragma once

#include <vector>

#include "control/activities/dig/dig.h"
#include "control/surface.h"
#include "core/archive.h"

namespace navvy::control {

/// The trench as seen from the swing axis.
struct TrenchLine {
  /// Ends in W [m]; `far` is farther from the swing axis.
  Vec2 near = Vec2::Zero(), far = Vec2::Zero();
  /// Distances of the ends from the swing axis, along the line [m].
  double near_reach = 0, far_reach = 0;
  /// Angle of the swing joint over the line [rad].
  double swing = 0;
  /// Distance of the line from the swing axis [m].
  double offset = 0;

  void visit(Archive& a);
};

/// Returns the trench as seen from a machine whose swing axis has the frame X_WS.
TrenchLine trench_line(const Dig& dig, const Pose& X_WS);

/// One scoop along the line, in metres from the near end.
struct Scoop {
  /// Start and end; start > end [m].
  double start = 0, end = 0;
  /// Position where the scoop's soil begins [m]: at `start`, or after a run over ground that is
  /// already dug.
  double soil = 0;
  /// Depth of the tip below the surface at the start of the dig [m].
  double level = 0;
  /// False: nothing is left to dig.
  bool any = false;
};

/// Progress of a trench.
struct TrenchState {
  /// Soil within the design's outline and above its floor [m3].
  double left = 0;
  /// Depth below the original surface that half of the length has reached [m].
  double depth = 0;
};

/// Plan of a straight trench: the surface along its line before the dig, and the depth that can be
/// dug.
class DigPlan {
 public:
  /// Creates an empty plan, to be replaced or loaded into.
  DigPlan() = default;
  /// Plans a trench from the present surface. `scoop_volume` is the bank volume of a full bucket
  /// [m3].
  DigPlan(const Dig& dig, const TrenchLine& line, double scoop_volume, const SurfaceView& surface);

  /// Returns the next scoop: in the highest slice that still holds a worthwhile share of a bucket,
  /// from its far end.
  Scoop next(const SurfaceView& surface) const;
  /// Marks the soil at `s`, where a scoop brought nothing, as undiggable below its present depth.
  void refuse(const SurfaceView& surface, double s);
  /// Makes slices thinner from now on, for soil that holds the bucket. Returns false when they are
  /// as thin as allowed.
  bool thin();
  /// Returns the thickness of a slice [m]: slices are equal, and none is thicker than commanded.
  double slice() const { return dig_.depth / slices(); }
  /// Returns a pass along the whole floor.
  Scoop clean_up() const { return {length_, 0, length_, dig_.depth, true}; }
  /// Returns the soil above depth `level` over the trench's width [m3].
  double volume_above(const SurfaceView& surface, double level) const;
  /// Returns the progress against the commanded trench; undiggable soil counts as left.
  TrenchState state(const SurfaceView& surface) const;
  /// Returns the height of the original surface at `s` [m] in W.
  double start_height(double s) const;
  /// Returns the highest soil at `s` on both edges of the cut and half a metre beside, at least the
  /// original height [m].
  double highest_beside(const SurfaceView& surface, double s) const;
  /// Returns W (x, y) on the centre line at `s` [m] from the near end.
  Vec2 point(double s) const { return line_.near + s * along_; }
  /// Length of the trench [m].
  double length() const { return length_; }
  /// Volume of the commanded trench [m3].
  double design_volume() const { return length_ * dig_.width * dig_.depth; }

  void visit(Archive& a);

 private:
  double fill_end(const SurfaceView& surface, int start, double level) const;
  double height(const SurfaceView& surface, double s) const;
  /// Returns the height of diggable soil above depth `level` at sample i [m], negative where the
  /// ground is lower.
  double remaining(const SurfaceView& surface, int i, double level) const;
  /// Returns the sample from which a scoop into the soil at sample i starts.
  int run_up(const SurfaceView& surface, int i, double level) const;
  /// Returns the soil above depth `level` between samples i - 1 and i [m3].
  double piece_above(const SurfaceView& surface, int i, double level) const;
  double at(int i) const { return length_ * i / (samples() - 1); }
  int slices() const;
  int samples() const { return static_cast<int>(start_.size()); }
  void derive();

  Dig dig_;
  TrenchLine line_;
  double scoop_volume_ = 0;
  // Original heights in W from near to far [m].
  std::vector<double> start_;
  // Depth that can be dug at each sample [m].
  std::vector<double> deepest_;
  Vec2 along_ = Vec2::UnitX();
  double length_ = 1;
};

}  // namespace navvy::control
