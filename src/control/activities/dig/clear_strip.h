// SPDX-License-Identifier: Apache-2.0
// Strips of ground along which a bucket takes up bodies. The activity and the check before a run
// share them. Private to the dig.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "control/arm_kinematics.h"
#include "control/body_view.h"
#include "control/dig_pose.h"
#include "control/surface.h"
#include "core/archive.h"

namespace navvy::control {

/// A line on the ground, radial to the swing axis, along which the bucket's edge is drawn to take
/// up a body.
struct ClearStrip {
  /// Ends of the line in W [m], the nearer and the farther one.
  Vec2 near = Vec2::Zero(), far = Vec2::Zero();
  /// Heights in W of the edge's path at both ends, the nearer first [m].
  std::vector<double> floor = {0, 0};
  /// Height in W above which the bucket clears all bodies while it swings [m].
  double rim = 0;
  /// Numbers of other bodies where the bucket goes down, which would hold it, and in front of the
  /// body, which it would push.
  std::int64_t behind = 0, before = 0;

  /// Saves or loads all fields.
  void visit(Archive& a);
};

/// Returns the part of the bodies whose middle is inside a polygon.
std::vector<BodyView> bodies_in(const std::vector<Vec2>& polygon,
                                const std::vector<BodyView>& bodies);

/// Returns the height in W above which the bucket clears bodies that it can reach and the ground
/// below it [m]. X_WS is the pose of the swing axis frame in W.
double rim_over(const ArmKinematics& arm, const Pose& X_WS, const std::vector<BodyView>& bodies);

/// Returns the distances from the swing axis between which the middle of `body` must be so that the
/// bucket can be drawn under it from behind [m]; both 0 if it never can. `rim` as ClearStrip::rim.
TipReach clear_reach(const ArmKinematics& arm, const Pose& X_WS, const BodyView& body, double rim,
                     const SurfaceView& surface);

/// Returns the strip that takes up `body` with the edge `depth` [m] below the ground, or as deep as
/// the body; nothing if the body is out of reach. The strip begins in front of other `bodies`
/// behind this one where that leaves the bucket enough distance.
std::optional<ClearStrip> clear_strip(const ArmKinematics& arm, const Pose& X_WS,
                                      const BodyView& body, const std::vector<BodyView>& bodies,
                                      double depth, const SurfaceView& surface);

}  // namespace navvy::control
