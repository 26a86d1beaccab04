// SPDX-License-Identifier: Apache-2.0
// Places on which a bucket is pressed to compact the ground. Private to compact.
#pragma once

#include <vector>

#include "control/arm_kinematics.h"
#include "control/dig_pose.h"
#include "control/surface.h"

namespace navvy::control {

/// The part of a bucket's underside behind its cutting edge that lies flat on the ground.
struct FlatBottom {
  /// Angle of the line from the bucket's pin to its tip at which it is level [rad].
  double angle = 0;
  /// Length from the tip outwards, and width across the arm [m]. The length is 0 for a bucket
  /// whose shell is unknown.
  double length = 0, width = 0;

  /// Returns the place (x, y) of the tip at which the middle of the bottom is over `place`, for a
  /// swing axis at `axis` (W).
  Vec2 tip_at(const Vec2& place, const Vec2& axis) const {
    return place - 0.5 * length * (place - axis).normalized();
  }
};

/// Returns the flat bottom of the arm's bucket, by its shell: the angle at which the most of the
/// shell is within 2 cm of level.
FlatBottom flat_bottom(const ArmKinematics& arm);

/// Returns the places (x, y) in W of the middle of the flat bottom that together cover a polygon,
/// for a machine whose swing axis is at `axis`. They stand in rings about that axis, one length of
/// the bottom apart, and in each ring side by side, overlapping by 5 cm. No place lies beyond the
/// polygon by more than it has to for the bottom to cover it. The direction changes from ring to
/// ring, so that moves between places are short.
std::vector<Vec2> press_places(const std::vector<Vec2>& polygon, const Vec2& axis,
                               const FlatBottom& bottom);

/// Returns the height in W [m] of the highest ground under the flat bottom at `place`.
double ground_under(const SurfaceView& surface, const Vec2& place, const Vec2& axis,
                    const FlatBottom& bottom);

/// Returns true if the flat bottom can lie level, to 3 deg, with the tip at `tip`.
bool can_press_at(const ArmKinematics& arm, const FlatBottom& bottom, const SwingPoint& tip);

}  // namespace navvy::control
