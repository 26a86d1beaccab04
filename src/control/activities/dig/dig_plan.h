// SPDX-License-Identifier: Apache-2.0
// Where the next scoop goes: slice by slice, from the far end to the near one.
#pragma once

#include <vector>

#include "control/activities/dig/dig.h"
#include "control/surface.h"
#include "core/archive.h"

namespace navvy::control {

/// The trench seen from the swing axis.
struct TrenchLine {
  /// Ends in W [m]; `far` is farther from the swing axis.
  Vec2 near = Vec2::Zero(), far = Vec2::Zero();
  double near_reach = 0, far_reach = 0;  ///< from the axis, along the line [m]
  double swing = 0;                      ///< angle of the swing joint over the line [rad]
  double offset = 0;                     ///< distance of the line from the swing axis [m]

  void visit(Archive& a);
};

/// The trench seen from a machine whose frame S of the swing axis is X_WS.
TrenchLine trench_line(const Dig& dig, const Pose& X_WS);

/// One scoop along the line, in metres from the near end.
struct Scoop {
  double start = 0, end = 0;  ///< start > end
  /// Where its soil begins: at `start`, or after a run over what is dug already.
  double soil = 0;
  double level = 0;  ///< depth of the tip below the surface at the start of the dig [m]
  bool any = false;  ///< false: nothing left to dig
};

/// How far a trench has come.
struct TrenchState {
  double left = 0;   ///< soil within the design's outline and above its floor [m3]
  double depth = 0;  ///< under the surface before the dig that half of the length has reached [m]
};

/// A straight trench: the surface along its line before the dig, what is left above a slice's floor
/// now.
class DigPlan {
 public:
  /// Of no trench: holds nothing to dig, to be replaced or loaded into.
  DigPlan() = default;
  /// `scoop_volume`: bank volume of a full bucket [m3].
  DigPlan(const Dig& dig, const TrenchLine& line, double scoop_volume, const SurfaceView& surface);

  /// The next scoop: the highest slice that still holds a worthwhile share of a bucket, begun at
  /// its far end.
  Scoop next(const SurfaceView& surface) const;
  /// The soil where a scoop from `s` brought nothing is taken as undiggable below what it is now,
  /// and left.
  void refuse(const SurfaceView& surface, double s);
  /// Soil that holds the bucket is dug in thinner slices from now on. False: they are as thin as
  /// they get.
  bool thin();
  /// Thickness of a slice: they are equal, and none is thicker than ordered [m].
  double slice() const { return dig_.depth / slices(); }
  /// A pass along the whole floor.
  Scoop clean_up() const { return {length_, 0, length_, dig_.depth, true}; }
  /// Soil above depth `level` over the trench's width [m3].
  double volume_above(const SurfaceView& surface, double level) const;
  /// Against the trench as ordered: soil that was found undiggable counts as left.
  TrenchState state(const SurfaceView& surface) const;
  /// W height of the surface before the dig at `s` [m].
  double start_height(double s) const;
  /// Highest soil at `s` on both edges of the cut and half a metre beside, at least the height
  /// before the dig [m].
  double highest_beside(const SurfaceView& surface, double s) const;
  /// W (x, y) on the centre line at `s` [m] from the near end.
  Vec2 point(double s) const { return line_.near + s * along_; }
  /// [m]
  double length() const { return length_; }
  /// Of the trench as ordered [m3].
  double design_volume() const { return length_ * dig_.width * dig_.depth; }

  void visit(Archive& a);

 private:
  double fill_end(const SurfaceView& surface, int start, double level) const;
  double height(const SurfaceView& surface, double s) const;
  /// Height of soil above depth `level` at sample i that can be dug, negative where it is dug
  /// deeper [m].
  double remaining(const SurfaceView& surface, int i, double level) const;
  /// Sample from which a scoop into the soil at sample i begins.
  int run_up(const SurfaceView& surface, int i, double level) const;
  /// Soil above depth `level` between samples i - 1 and i [m3].
  double piece_above(const SurfaceView& surface, int i, double level) const;
  double at(int i) const { return length_ * i / (samples() - 1); }
  int slices() const;
  int samples() const { return static_cast<int>(start_.size()); }
  void derive();

  Dig dig_;
  TrenchLine line_;
  double scoop_volume_ = 0;
  std::vector<double> start_;    // W heights from near to far [m]
  std::vector<double> deepest_;  // depth that can be dug there [m]
  Vec2 along_ = Vec2::UnitX();
  double length_ = 1;
};

}  // namespace navvy::control
