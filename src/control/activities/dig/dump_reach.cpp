// SPDX-License-Identifier: Apache-2.0
#include "control/activities/dig/dump_reach.h"

#include "control/dig_pose.h"

namespace navvy::control {
namespace {

constexpr double kLeastHeight = 0.3;  // of a dump [m]
constexpr double kStep = 0.05;        // of the search for a distance [m]

}  // namespace

void require_dump(ReachCheck& check, const ArmKinematics& arm, const Pose& X_WS,
                  const std::string& step, const DumpPoint& dump) {
  const std::string element = step + "/dump_at";
  // The ground before the dig: the operator observes the heap that grows there.
  const double ground = check.surface.height(dump.at.x(), dump.at.y());
  const SwingPoint at = swing_point(X_WS, Vec3(dump.at.x(), dump.at.y(), ground));
  check.require_swing(arm, element.c_str(), at.swing, kMoveOrTurn);
  ArmAngles q;
  double possible = 0;
  const bool any = dump_pose(arm, X_WS, dump.at, ground, dump.height, q, possible);
  // Half a step of the search for the clearance is no fault.
  if (any && possible > dump.height - 0.026) return;
  if (any) {
    check.fault(step + "/dump_height", metres(dump.height),
                "with a level bucket " + metres(at.reach) +
                    " from the swing axis the tip opens at most " + metres(possible) +
                    " over the ground",
                "dump lower, nearer or farther; on a map, --at another place");
    return;
  }
  double least = 0, most = 0;
  // Nothing is possible at this distance: search in the same direction.
  const Vec2 axis = X_WS.translation().head<2>(), u = (dump.at - axis).normalized();
  for (double r = 1; r < arm.longest() + 2; r += kStep) {
    if (!dump_pose(arm, X_WS, axis + r * u, ground, kLeastHeight, q, possible)) continue;
    if (most == 0) least = r;
    most = r;
  }
  check.fault(element, metres(at.reach) + " from the swing axis",
              most > 0 ? "a level bucket can be opened from " + metres(least) + " to " +
                             metres(most) + " in that direction"
                       : "the ground there is " + metres(at.height) +
                             " over the swing ring: a level bucket can be opened over it nowhere "
                             "in that direction",
              "move the dump point or the machine; on a map, --at another place");
}

}  // namespace navvy::control
