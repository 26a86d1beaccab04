// SPDX-License-Identifier: Apache-2.0
// Plans the scoops of a trench. The trench is dug slice by slice from top to bottom, and each slice
// from the far end to the near end.
#pragma once

#include <vector>

#include "control/activities/dig/dig.h"
#include "control/surface.h"
#include "core/archive.h"

namespace navvy::control {

/// Centre line of a trench as seen from the machine's swing axis.
struct TrenchLine {
  /// Ends of the line in W (x, y) [m]: the one nearer to the swing axis, and the one farther from
  /// it.
  Vec2 near = Vec2::Zero(), far = Vec2::Zero();
  /// Distances of the two ends from the swing axis [m], measured in the direction of the line.
  double near_reach = 0, far_reach = 0;
  /// Swing angle at which the arm is parallel to the line [rad].
  double swing = 0;
  /// Perpendicular distance of the line from the swing axis [m].
  double offset = 0;

  /// Saves or loads all fields.
  void visit(Archive& a);
};

/// Returns the line of the trench `dig`, whose ends are given in W, relative to a machine whose
/// swing axis frame S has the pose X_WS in W.
TrenchLine trench_line(const Dig& dig, const Pose& X_WS);

/// One scoop along the trench. Positions are distances from the near end of the trench [m].
struct Scoop {
  /// Positions at which the scoop starts and ends. The bucket moves towards the machine, so `start`
  /// is greater than `end`.
  double start = 0, end = 0;
  /// Position at which the bucket meets soil. It is less than `start` if the scoop starts over
  /// finished floor.
  double soil = 0;
  /// Depth of the bucket's tip below the original surface [m].
  double level = 0;
  /// False if nothing is left to dig; the other fields are meaningless then.
  bool any = false;
};

/// Progress of a trench.
struct TrenchState {
  /// Volume of soil that is still inside the commanded trench [m3].
  double left = 0;
  /// Median depth below the original surface along the centre line [m]: half of the trench's length
  /// is at least this deep.
  double depth = 0;
  /// Share of the centre line on which less than 0.1 m of soil is left above the floor [-].
  double floor = 0;
  /// Returns true if more than a fifth of the floor is not down yet.
  bool is_rough() const { return floor < 0.8; }
};

/// Plan of a straight trench. It stores the original surface along the centre line and the depth
/// that can be dug there, and selects the next scoop from the current surface. The parameter `s` is
/// the distance from the near end along the centre line [m].
class DigPlan {
 public:
  /// Makes an empty plan. Assign another plan to it, or load one, before use.
  DigPlan() = default;
  /// Makes an empty plan of the trench `dig`, to load the state of one.
  explicit DigPlan(const Dig& dig) : dig_(dig) {}
  /// Makes the plan of the trench `dig` with the centre line `line`. `surface` is the original
  /// surface, and `scoop_volume` the volume that a full bucket takes from undisturbed ground [m3].
  DigPlan(const Dig& dig, const TrenchLine& line, double scoop_volume, const SurfaceView& surface);

  /// Returns the next scoop. It is in the uppermost slice that still has enough soil, and it starts
  /// at the farthest soil of that slice, or before it over finished floor. If `hindered`, something
  /// in the ground held the last scoop, and the next one starts at the soil.
  Scoop next(const SurfaceView& surface, bool hindered) const;
  /// Marks the ground around `s` [m] as impossible to dig below its current depth. Call it for a
  /// scoop that came up nearly empty.
  void refuse(const SurfaceView& surface, double s);
  /// Reduces the thickness of the following slices, for soil that holds the bucket. Returns false
  /// if the slices already have their minimum thickness.
  bool thin();
  /// Returns the mean thickness of a slice [m]. No slice is thicker than `Dig::pass_depth`, unless
  /// by less than one load.
  double slice() const { return dig_.depth / slices(); }
  /// Returns a scoop along the floor of the trench, from the farthest soil on it, if it would bring
  /// a load worth a cycle. `hindered` as in `next`.
  Scoop clean_up(const SurfaceView& surface, bool hindered) const;
  /// Returns a scoop along the whole floor.
  Scoop whole_floor() const { return {length_, 0, length_, dig_.depth, true}; }
  /// Returns the volume of soil [m3] that is inside the width of the trench and above a given
  /// depth. `level` is that depth below the original surface [m]. Soil that cannot be dug does not
  /// count.
  double volume_above(const SurfaceView& surface, double level) const;
  /// Returns the progress relative to the commanded trench on the current `surface`. Unlike in
  /// `volume_above`, soil that cannot be dug counts as left.
  TrenchState state(const SurfaceView& surface) const;
  /// Returns the height of the original surface at `s` [m] in W [m].
  double start_height(double s) const;
  /// Returns the height in W [m] down to which a pass at the depth `level` [m] digs at `s` [m]: the
  /// floor of the trench, if that is higher.
  double floor_height(double s, double level) const;
  /// Returns the height in W [m] of the highest ground at `s` [m] beside the trench: from its edges
  /// to half a metre beyond them. The result is at least the original height.
  double highest_beside(const SurfaceView& surface, double s) const;
  /// Returns the point (x, y) in W [m] on the centre line at `s` [m].
  Vec2 point(double s) const { return line_.near + s * along_; }
  /// Returns the length of the trench [m].
  double length() const { return length_; }
  /// Returns the volume of the commanded trench [m3].
  double design_volume() const;

  /// Saves or loads the plan.
  void visit(Archive& a);

 private:
  /// Returns the position [m] at which a scoop in the slice down to depth `level` [m], starting at
  /// sample `start`, has a full load; 0, the near end, if the soil is less than that.
  double fill_end(const SurfaceView& surface, int start, double level) const;
  /// Returns the mean height in W [m] of the current surface across the middle of the trench at `s`
  /// [m].
  double height(const SurfaceView& surface, double s) const;
  /// Returns the height [m] of the soil at sample `i` that can be dug and is above the depth
  /// `level` [m]; negative if the ground is already lower.
  double remaining(const SurfaceView& surface, int i, double level) const;
  /// Returns the sample at which a scoop should start whose soil begins at sample `i`. Near the
  /// machine this is farther out, over floor with less than `least` [m] of soil on it, so that the
  /// bucket has enough distance to fill.
  int run_up(const SurfaceView& surface, int i, double level, double least, bool hindered) const;
  /// Returns true if more than `least` [m] of soil stands above the depth `level` [m] at sample `i`
  /// and on average over the length that follows it.
  bool stands(const SurfaceView& surface, int i, double level, double least) const;
  /// Returns the volume above the floor of the trench that a pass along it can take [m3]: not the
  /// ramp at the near end.
  double volume_on_floor(const SurfaceView& surface) const;
  /// Returns the volume of soil above the depth `level` [m] between the samples i - 1 and i [m3].
  double piece_above(const SurfaceView& surface, int i, double level) const;
  /// Returns the distance of sample `i` from the near end [m].
  double at(int i) const { return length_ * i / (samples() - 1); }
  /// Returns the number of slices.
  int slices() const;
  /// Returns the number of loads that the commanded trench is divided into, at least one a slice.
  int loads() const;
  /// Returns the depth of the bottom of slice `k`, counted from 1 [m]. A slice holds whole loads,
  /// so slices differ in thickness if the loads cannot be shared out evenly.
  double level_of(int k) const;
  /// Returns the volume below which a rest of the trench is left [m3].
  double least_rest() const;
  /// Returns the number of sample points along the centre line.
  int samples() const { return static_cast<int>(start_.size()); }
  /// Computes `along_` and `length_` from the ends of the line.
  void derive();

  /// Returns the depth of the floor at sample `i` below the original surface [m].
  double floor_depth(int i) const;
  /// Returns the values of samples between `near` and `far`, linear at `s` [m].
  double between(const std::vector<double>& values, double s) const;

  // Commanded trench; `thin` reduces its pass depth.
  Dig dig_;
  // Centre line of the trench as seen when the plan was made.
  TrenchLine line_;
  // Volume that a full bucket takes from undisturbed ground [m3].
  double scoop_volume_ = 0;
  // Height of the original surface in W at each sample, from the near to the far end [m].
  std::vector<double> start_;
  // Maximum depth that can be dug at each sample, below the original surface [m].
  std::vector<double> deepest_;
  // Unit vector from the near to the far end in W.
  Vec2 along_ = Vec2::UnitX();
  // Length of the trench [m].
  double length_ = 1;
};

}  // namespace navvy::control
