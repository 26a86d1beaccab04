// SPDX-License-Identifier: Apache-2.0
// Checks that bodies can be taken up and dumped from where the machine stands.
#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "control/activities/dig/clear.h"
#include "control/activities/dig/clear_strip.h"
#include "control/activities/dig/dump_reach.h"
#include "control/reach.h"
#include "vehicle/rating/lift_capacity.h"
#include "vehicle/rating/tool_force.h"

namespace navvy::control {
namespace {

constexpr double kWidthClear = 0.1;   // of a body in the bucket [m]
constexpr double kLiftHeight = 1.0;   // of the bucket's pin with a body [m]
constexpr double kEdgeSample = 0.25;  // along the polygon's edges [m]

/// Checks one clear step at one pose of the machine.
class ClearCheck {
 public:
  ClearCheck(const Clear& step, ReachCheck& check)
      : step_(step), check_(check), arm_(check.machine), X_WS_(check.X_WB * arm_.X_BS()) {
    if (!vehicle::tool_force_fault(check.machine))
      lift_ = std::make_unique<vehicle::LiftChart>(check.machine, true);
  }

  void look() {
    if (step_.polygon.empty()) return;
    require_dump(check_, arm_, X_WS_, step_.element(), *step_.dump_point());
    require_area();
    const std::vector<BodyView> bodies = bodies_in(step_.polygon, check_.bodies);
    if (bodies.empty())
      check_.warn(part("polygon_m"), place_text(step_.polygon.front()),
                  "no loose body is in the polygon",
                  "give its corners as x y in the world, or leave out the step");
    const double rim = rim_over(arm_, X_WS_, check_.bodies);
    for (const BodyView& body : bodies) {
      require_shell(body);
      require_size(body);
      require_place(body, rim);
      require_mass(body);
    }
    check_.note(std::to_string(bodies.size()) + (bodies.size() == 1 ? " body" : " bodies") +
                " in the polygon");
  }

 private:
  std::string part(const char* name) const { return std::string(step_.element()) + "/" + name; }

  /// Adds an error about a body; a warning after steps that may have moved it.
  void fault(const BodyView& body, const std::string& value, const std::string& rule,
             const std::string& remedy) {
    const std::string text =
        "'" + body.name + "' at " + place_text(body.centre.head<2>()) + ": " + value;
    if (check_.after_digging())
      check_.warn(part("polygon_m"), text, rule, remedy);
    else
      check_.fault(part("polygon_m"), text, rule, remedy);
  }

  /// Reports a polygon no part of which is within reach.
  void require_area() {
    double nearest = 1e9;
    for (std::size_t i = 0; i < step_.polygon.size(); ++i) {
      const Vec2 &a = step_.polygon[i], along = step_.polygon[(i + 1) % step_.polygon.size()] - a;
      const int samples = 1 + static_cast<int>(along.norm() / kEdgeSample);
      for (int k = 0; k < samples; ++k) {
        const Vec2 p = a + along * k / samples;
        const SwingPoint at =
            swing_point(X_WS_, Vec3(p.x(), p.y(), check_.surface.height(p.x(), p.y())));
        if (at.reach >= kNearestDig && can_dig_at(arm_, at.reach, at.height, at.pitch)) return;
        nearest = std::min(nearest, at.reach);
      }
    }
    const Vec2& p = step_.polygon.front();
    const SwingPoint at =
        swing_point(X_WS_, Vec3(p.x(), p.y(), check_.surface.height(p.x(), p.y())));
    const TipReach tip = tip_reach(arm_, at.height, at.pitch);
    check_.fault(part("polygon_m"), metres(nearest) + " from the swing axis",
                 "the bucket's tip reaches from " + metres(std::max(kNearestDig, tip.least)) +
                     " to " + metres(tip.most) + " there, and no part of the polygon is between",
                 "drive the machine to it before this step");
  }

  void require_shell(const BodyView& body) {
    if (body.has_shell) return;
    check_.warn(part("polygon_m"), "'" + body.name + "' at " + place_text(body.centre.head<2>()),
                "without a navvy:shell a body sinks through loose soil, below the bucket's edge",
                "give it a closed shell of the size of its collision shape");
  }

  void require_size(const BodyView& body) {
    const double most = arm_.bucket().width - kWidthClear;
    if (body.largest <= most) return;
    fault(body, metres(body.largest) + " large",
          "the bucket takes bodies of at most " + metres(most),
          "break it, or take a machine with a larger bucket");
  }

  void require_place(const BodyView& body, double rim) {
    const SwingPoint at = swing_point(X_WS_, body.centre);
    check_.require_swing(arm_, part("polygon_m").c_str(), at.swing, kMoveOrTurn);
    const TipReach possible = clear_reach(arm_, X_WS_, body, rim, check_.surface);
    if (at.reach >= possible.least && at.reach <= possible.most) return;
    fault(body, metres(at.reach) + " from the swing axis",
          possible.most > 0 ? "the bucket takes up a body of this size from " +
                                  metres(possible.least) + " to " + metres(possible.most)
                            : "the bucket can take up no body of this size on this ground",
          at.reach > possible.most ? "stand nearer, or make the polygon smaller"
                                   : "stand farther back, or make the polygon smaller");
  }

  /// Reports a body that is too heavy where it lies or where it is dumped.
  void require_mass(const BodyView& body) {
    if (!lift_) return;
    for (const Vec2& p : {Vec2(body.centre.head<2>()), step_.dump_at}) {
      const SwingPoint at = swing_point(X_WS_, Vec3(p.x(), p.y(), body.centre.z()));
      const auto most = lift_->at(at.reach, kLiftHeight, at.swing);
      if (!most || body.mass <= most->rated()) continue;
      fault(body, number_text(body.mass, "kg"),
            "the arm lifts at most " + number_text(most->rated(), "kg") + " at " +
                metres(at.reach) + " from the swing axis, " +
                (most->is_hydraulic() ? "by its hydraulics" : "or the machine tips over"),
            "stand nearer, or take a larger machine");
      return;
    }
  }

  const Clear& step_;
  ReachCheck& check_;
  const ArmKinematics arm_;
  const Pose X_WS_;  // frame of the swing axis
  std::unique_ptr<vehicle::LiftChart> lift_;
};

}  // namespace

void Clear::check_reach(ReachCheck& check) const { ClearCheck(*this, check).look(); }

}  // namespace navvy::control
