// SPDX-License-Identifier: Apache-2.0
// Checks that a trench and its spoil can be reached from where the machine stands.
#include <algorithm>
#include <cmath>
#include <utility>

#include "control/activities/dig/dig.h"
#include "control/activities/dig/dig_plan.h"
#include "control/activities/dig/dump_reach.h"
#include "control/dig_pose.h"
#include "control/reach.h"

namespace navvy::control {
namespace {

constexpr double kMostOffset = 0.15;  // of the trench's line from the swing axis [m]
constexpr double kWiderCut = 0.1;     // than the bucket [m]
constexpr double kSpoilClear = 0.5;   // dump point to the trench's edge [m]

/// Checks one dig at one pose of the machine. Stops at a line beside the swing axis, as everything
/// else would be wrong, too.
class DigReach {
 public:
  DigReach(const Dig& dig, ReachCheck& check)
      : dig_(dig), check_(check), arm_(check.machine), X_WS_(check.X_WB * arm_.X_BS()) {}

  void look() {
    const TrenchLine line = trench_line(dig_, X_WS_);
    // A bucket cannot be moved sideways within a line: one cut is one bucket wide.
    if (dig_.width > arm_.bucket().width + kWiderCut)
      check_.fault("dig/width", metres(dig_.width),
                   "the bucket cuts " + metres(arm_.bucket().width),
                   "dig a trench one bucket wide, or several side by side");
    if (line.offset > kMostOffset) {
      // Position of the rear axle from which the line would be seen along its length at the same
      // distance.
      const Vec2 u = (line.far - line.near).normalized();
      const Vec2 axis = line.near - line.near_reach * u;
      const Vec2 origin = axis - arm_.X_BS().translation().x() * u;
      check_.fault("dig", metres(line.offset) + " beside the swing axis",
                   "the trench's line must pass the swing axis within " + metres(kMostOffset),
                   "stand at " + place_text(origin) + " with heading " +
                       number_text(degrees(std::atan2(u.y(), u.x())), "deg") +
                       ", or turn the line towards the machine");
      return;
    }
    if (line.near_reach < kNearestDig)
      check_.fault("dig/near end", metres(line.near_reach) + " from the swing axis",
                   "the trench must stay " + metres(kNearestDig) + " clear of it",
                   "end it farther away or stand farther back");
    check_.require_swing(arm_, "dig/line", line.swing, kMoveOrTurn);
    for (const auto& [name, p] :
         {std::pair{"dig/far end", line.far}, std::pair{"dig/near end", line.near}}) {
      // Over the ground before it goes down, and on the finished floor.
      require_tip(name, p, check_.surface.height(p.x(), p.y()) + kClear);
      require_tip(name, p, check_.surface.height(p.x(), p.y()) - dig_.depth);
    }
    require_dump(check_, arm_, X_WS_, "dig", {dig_.dump_at, dig_.dump_height});
    // Distance of the dump point from the line between the ends, not beyond them.
    const Vec2 along = line.near - line.far;
    const double share =
        std::clamp((dig_.dump_at - line.far).dot(along) / along.squaredNorm(), 0.0, 1.0);
    const double away = (dig_.dump_at - line.far - share * along).norm();
    if (away < 0.5 * dig_.width + kSpoilClear)
      check_.fault("dig/dump_at", metres(away) + " from the trench's line",
                   "spoil must fall " + metres(kSpoilClear) + " clear of the trench's edge",
                   "dump farther aside");
  }

 private:
  /// Checks the tip at W (p, z), digging or plunging.
  void require_tip(const char* element, const Vec2& p, double z) {
    const SwingPoint at = swing_point(X_WS_, Vec3(p.x(), p.y(), z));
    if (can_dig_at(arm_, at.reach, at.height, at.pitch)) return;
    // How far would have been possible at that height: the message shall help to place the machine.
    const auto [least, most] = tip_reach(arm_, at.height, at.pitch);
    check_.fault(element,
                 metres(at.reach) + " from the swing axis at height " + metres(z) + " (" +
                     metres(at.height) + " over the swing ring)",
                 most > 0 ? "at that height the bucket's tip reaches from " + metres(least) +
                                " to " + metres(most)
                          : "the tip never gets to that height",
                 at.reach > most ? "stand nearer, or dig less deep or far" : "stand farther back");
  }

  const Dig& dig_;
  ReachCheck& check_;
  const ArmKinematics arm_;
  const Pose X_WS_;  // frame of the swing axis
};

}  // namespace

void Dig::check_reach(ReachCheck& check) const { DigReach(*this, check).look(); }

}  // namespace navvy::control
