// SPDX-License-Identifier: Apache-2.0
// Looks over a program before the run: what cannot be reached is told at once.
#include <cmath>
#include <cstdio>

#include "control/arm.h"
#include "control/dig_plan.h"
#include "control/operator.h"

namespace navvy::control {
namespace {

constexpr double kMostOffset = 0.15;  // of the trench's line from the swing axis [m]

std::string metres(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.2f m", value);
  return text;
}

class ReachCheck {
 public:
  ReachCheck(const scene::Machine& machine, const scene::Program& program, const heightfield::Ground& ground,
             std::string file)
      : machine_(machine), program_(program), ground_(ground), file_(std::move(file)) {}

  void look(std::size_t index, const Pose& X_WB) {
    index_ = index;
    if (const auto* dig = std::get_if<scene::Dig>(&program_.steps[index])) look(*dig, X_WB);
    if (const auto* swing = std::get_if<scene::Swing>(&program_.steps[index])) look(*swing);
  }
  std::vector<Fault> faults;

 private:
  void fault(const std::string& element, const std::string& value, const std::string& rule, const std::string& remedy) {
    const int line = index_ < program_.lines.size() ? program_.lines[index_] : 0;
    faults.push_back({Fault::Severity::kError, file_, line,
                      machine_.name + "/navvy:program/step " + std::to_string(index_ + 1) + "/" + element, value, rule,
                      remedy});
  }

  void look(const scene::Swing& swing) {
    const Arm arm(machine_);
    if (arm.swing_limited() && (swing.angle < arm.swing_lower() || swing.angle > arm.swing_upper()))
      fault("swing", std::to_string(degrees(swing.angle)) + " deg", "is outside the swing joint's limits",
            "choose an angle between them");
  }

  /// Tip at `reach`, `height` in S with any bucket angle that digs.
  void require(const Arm& arm, const std::string& element, double reach, double height) {
    BucketPose pose{reach, height, -kPi / 2};
    ArmAngles q;
    if (arm.inverse_nearest(pose, q)) return;
    double possible = 0;
    for (double r = 0; r < arm.longest() + 2; r += 0.02) {
      pose = {r, height, -kPi / 2};
      if (arm.inverse_nearest(pose, q)) possible = r;
    }
    fault(element, metres(reach) + " from the swing axis, " + metres(height) + " above it",
          possible > 0 ? "at that height the bucket's tip reaches " + metres(possible)
                       : "the tip never gets to that height",
          "drive nearer, or move the target");
  }

  void look(const scene::Dig& dig, const Pose& X_WB) {
    const Arm arm(machine_);
    const Pose X_WS = X_WB * arm.X_BS();
    const TrenchLine line = trench_line(dig, X_WS);
    if (line.offset > kMostOffset)
      fault("dig", metres(line.offset), "the trench's line must pass the swing axis within " + metres(kMostOffset),
            "place the machine on the line of the trench, or turn the line towards the machine");
    const auto height = [&](const Vec2& p) { return ground_.sample(p.x(), p.y()) - X_WS.translation().z(); };
    require(arm, "dig/far end", line.far_reach, height(line.far));
    require(arm, "dig/far floor", line.far_reach - 0.3, height(line.far) - dig.depth);
    require(arm, "dig/near floor", line.near_reach, height(line.near) - dig.depth);
    if (line.near_reach < 3.0)
      fault("dig/near end", metres(line.near_reach), "the near end must stay 3.00 m clear of the swing axis",
            "end the trench farther away or drive back");
    const Vec3 p = X_WS.inverse() * Vec3(dig.dump_at.x(), dig.dump_at.y(), X_WS.translation().z());
    require(arm, "dig/dump_at", std::hypot(p.x(), p.y()) - 0.7, height(dig.dump_at) + dig.dump_height + 0.7);
  }

  const scene::Machine& machine_;
  const scene::Program& program_;
  const heightfield::Ground& ground_;
  std::string file_;
  std::size_t index_ = 0;
};

}  // namespace

std::vector<Fault> check_reach(const scene::Machine& machine, const scene::Program& program, const Pose& X_WB,
                               const heightfield::Ground& ground, const std::string& file) {
  ReachCheck check(machine, program, ground, file);
  Pose X = X_WB;
  for (std::size_t i = 0; i < program.steps.size(); ++i) {
    if (const auto* drive = std::get_if<scene::DriveTo>(&program.steps[i])) {
      // Where the machine will stand, upright on the present ground.
      const Vec2 way = drive->target - X.translation().head<2>();
      const double sense = drive->speed < 0 ? -1 : 1;
      const double yaw = drive->has_heading ? drive->heading : std::atan2(sense * way.y(), sense * way.x());
      const double rise = X.translation().z() - ground.sample(X.translation().x(), X.translation().y());
      X = make_pose(drive->target.x(), drive->target.y(), ground.sample(drive->target.x(), drive->target.y()) + rise, 0,
                    0, yaw);
    }
    check.look(i, X);
  }
  return check.faults;
}

}  // namespace navvy::control
