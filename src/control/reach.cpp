// SPDX-License-Identifier: Apache-2.0
// Looks over a program before the run: what cannot be reached is told at once.
#include <cmath>
#include <cstdio>

#include "control/dig_plan.h"
#include "control/dig_pose.h"
#include "control/operator.h"
#include "control/pursuit.h"
#include "vehicle/drive/drive_line.h"

namespace navvy::control {
namespace {

constexpr double kMostOffset = 0.15;  // of the trench's line from the swing axis [m]
constexpr double kNearest = 3.0;      // end of the trench to the swing axis: clear of wheels and undercarriage [m]
constexpr double kWiderCut = 0.1;     // than the bucket [m]
constexpr double kSpoilClear = 0.5;   // dump point to the trench's edge [m]

std::string number(double value, const char* unit) {
  char text[48];
  std::snprintf(text, sizeof text, "%.2f %s", value, unit);
  return text;
}
std::string metres(double value) { return number(value, "m"); }
std::string place(const Vec2& p) { return "(" + number(p.x(), "") + ", " + number(p.y(), "") + ")"; }

/// Where the machine will stand: upright on the present ground.
Pose pose_after(const scene::DriveTo& drive, const scene::Machine& machine, const Pose& X_WB,
                const SurfaceView& surface) {
  const Vec3 from = X_WB.translation();
  const double rise = from.z() - surface.height(from.x(), from.y());
  const double heading = Pursuit::of(drive, machine.drive, plane_pose(X_WB)).heading;
  return make_pose(drive.target.x(), drive.target.y(), surface.height(drive.target.x(), drive.target.y()) + rise, 0, 0,
                   heading);
}

class ReachCheck {
 public:
  ReachCheck(const scene::Machine& machine, const scene::Program& program, const SurfaceView& surface, std::string file)
      : machine_(machine), program_(program), surface_(surface), file_(std::move(file)) {}

  /// Looks at one step; `X_WB` becomes where the machine stands after it.
  void look(std::size_t index, Pose& X_WB) {
    index_ = index;
    const scene::ProgramStep& step = program_.steps[index];
    if (const auto* drive = std::get_if<scene::DriveTo>(&step)) look(*drive, X_WB);
    if (const auto* dig = std::get_if<scene::Dig>(&step)) look(*dig, X_WB);
    if (const auto* swing = std::get_if<scene::Swing>(&step)) look(*swing);
  }
  std::vector<Fault> faults;

 private:
  void fault(const std::string& element, const std::string& value, const std::string& rule, const std::string& remedy) {
    const int line = index_ < program_.lines.size() ? program_.lines[index_] : 0;
    faults.push_back({Fault::Severity::kError, file_, line,
                      machine_.name + "/navvy:program/step " + std::to_string(index_ + 1) + "/" + element, value, rule,
                      remedy});
  }

  void look(const scene::DriveTo& drive, Pose& X_WB) {
    const PlanePose start = plane_pose(X_WB);
    const Pursuit pursuit = Pursuit::of(drive, machine_.drive, start);
    const PlanePose end = pursuit.end_from(start, vehicle::equivalent_bicycle(machine_.drive).steer_rate);
    const double miss = (end.p - drive.target).norm();
    if (miss > drive.tolerance)
      fault("drive_to", place(drive.target),
            "steering as far as it can the machine ends at " + place(end.p) + ", " + metres(miss) +
                " from the target; allowed are " + metres(drive.tolerance),
            "give it a longer way to turn in, or approach in two drives");
    X_WB = pose_after(drive, machine_, X_WB, surface_);
  }

  void look(const scene::Swing& swing) {
    const Arm arm(machine_);
    if (!arm.swing_limited() || (swing.angle >= arm.swing_lower() && swing.angle <= arm.swing_upper())) return;
    fault("swing", number(degrees(swing.angle), "deg"),
          "the swing joint turns from " + number(degrees(arm.swing_lower()), "deg") + " to " +
              number(degrees(arm.swing_upper()), "deg"),
          "choose an angle between them");
  }

  void look(const scene::Dig& dig, const Pose& X_WB) {
    const Arm arm(machine_);
    const Pose X_WS = X_WB * arm.X_BS();
    const TrenchLine line = trench_line(dig, X_WS);
    if (dig.width > arm.bucket().width + kWiderCut)
      fault("dig/width", metres(dig.width), "the bucket cuts " + metres(arm.bucket().width),
            "dig a trench one bucket wide, or several side by side");
    if (line.offset > kMostOffset) {
      // Where the rear axle had to stand to look along the line from the same distance.
      const Vec2 u = (line.far - line.near).normalized();
      const Vec2 axis = line.near - line.near_reach * u;
      const Vec2 origin = axis - arm.X_BS().translation().x() * u;
      fault("dig", metres(line.offset) + " beside the swing axis",
            "the trench's line must pass the swing axis within " + metres(kMostOffset),
            "stand at " + place(origin) + " with heading " + number(degrees(std::atan2(u.y(), u.x())), "deg") +
                ", or turn the line towards the machine");
      return;
    }
    if (line.near_reach < kNearest)
      fault("dig/near end", metres(line.near_reach) + " from the swing axis",
            "the trench must stay " + metres(kNearest) + " clear of it", "end it farther away or stand farther back");
    require_swing(arm, "dig/line", line.swing);
    for (const auto& [name, p] : {std::pair{"dig/far end", line.far}, std::pair{"dig/near end", line.near}}) {
      require_tip(arm, X_WS, name, p, surface_.height(p.x(), p.y()) + kClear);
      require_tip(arm, X_WS, name, p, surface_.height(p.x(), p.y()) - dig.depth);
    }
    require_dump(arm, X_WS, dig);
    const Vec2 along = line.near - line.far;
    const double share = std::clamp((dig.dump_at - line.far).dot(along) / along.squaredNorm(), 0.0, 1.0);
    const double away = (dig.dump_at - line.far - share * along).norm();
    if (away < 0.5 * dig.width + kSpoilClear)
      fault("dig/dump_at", metres(away) + " from the trench's line",
            "spoil must fall " + metres(kSpoilClear) + " clear of the trench's edge", "dump farther aside");
  }

  /// The tip at W (p, z), digging or plunging.
  void require_tip(const Arm& arm, const Pose& X_WS, const char* element, const Vec2& p, double z) {
    const SwingPoint at = swing_point(X_WS, Vec3(p.x(), p.y(), z));
    const auto possible = [&](double reach) {
      BucketPose pose{reach, at.height, at.level(with_cut(arm, kPlunge))};
      ArmAngles q;
      return arm.inverse_nearest(pose, q);
    };
    if (possible(at.reach)) return;
    double least = 0, most = 0;
    for (double r = 0.5; r < arm.longest() + 2; r += 0.02) {
      if (!possible(r)) continue;
      if (most == 0) least = r;
      most = r;
    }
    fault(element,
          metres(at.reach) + " from the swing axis at height " + metres(z) + " (" + metres(at.height) +
              " over the swing ring)",
          most > 0 ? "at that height the bucket's tip reaches from " + metres(least) + " to " + metres(most)
                   : "the tip never gets to that height",
          at.reach > most ? "stand nearer, or dig less deep or far" : "stand farther back");
  }

  void require_swing(const Arm& arm, const char* element, double swing) {
    if (!arm.swing_limited() || (swing >= arm.swing_lower() && swing <= arm.swing_upper())) return;
    fault(element, number(degrees(swing), "deg"),
          "the swing joint turns from " + number(degrees(arm.swing_lower()), "deg") + " to " +
              number(degrees(arm.swing_upper()), "deg"),
          "move the target or turn the machine");
  }

  void require_dump(const Arm& arm, const Pose& X_WS, const scene::Dig& dig) {
    const double ground = surface_.height(dig.dump_at.x(), dig.dump_at.y());
    const SwingPoint at = swing_point(X_WS, Vec3(dig.dump_at.x(), dig.dump_at.y(), ground));
    require_swing(arm, "dig/dump_at", at.swing);
    ArmAngles q;
    double possible = 0;
    const bool any = dump_pose(arm, X_WS, dig.dump_at, ground, dig.dump_height, q, possible);
    if (any && possible > dig.dump_height - 0.026) return;
    if (any) {
      fault("dig/dump_height", metres(dig.dump_height),
            "with a level bucket " + metres(at.reach) + " from the swing axis the tip opens at most " +
                metres(possible) + " over the ground",
            "dump lower, nearer or farther; on a map, --at another place");
      return;
    }
    double least = 0, most = 0;
    const Vec2 axis = X_WS.translation().head<2>(), u = (dig.dump_at - axis).normalized();
    for (double r = 1; r < arm.longest() + 2; r += 0.05) {
      if (!dump_pose(arm, X_WS, axis + r * u, ground, 0.3, q, possible)) continue;
      if (most == 0) least = r;
      most = r;
    }
    fault("dig/dump_at", metres(at.reach) + " from the swing axis",
          most > 0 ? "a level bucket can be opened from " + metres(least) + " to " + metres(most) + " in that direction"
                   : "the ground there is " + metres(at.height) +
                         " over the swing ring: a level bucket can be opened over it nowhere in that direction",
          "move the dump point or the machine; on a map, --at another place");
  }

  const scene::Machine& machine_;
  const scene::Program& program_;
  const SurfaceView& surface_;
  std::string file_;
  std::size_t index_ = 0;
};

}  // namespace

std::vector<Fault> check_reach(const scene::Machine& machine, const scene::Program& program, const Pose& X_WB,
                               const SurfaceView& surface, const std::string& file) {
  ReachCheck check(machine, program, surface, file);
  Pose X = X_WB;
  for (std::size_t i = 0; i < program.steps.size(); ++i) check.look(i, X);
  return check.faults;
}

std::vector<Pose> stations(const scene::Machine& machine, const scene::Program& program, const Pose& X_WB,
                           const SurfaceView& surface) {
  std::vector<Pose> out{X_WB};
  for (const scene::ProgramStep& step : program.steps)
    if (const auto* drive = std::get_if<scene::DriveTo>(&step))
      out.push_back(pose_after(*drive, machine, out.back(), surface));
  return out;
}

}  // namespace navvy::control
