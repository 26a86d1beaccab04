// SPDX-License-Identifier: Apache-2.0
// Private to the operator: its memory and the parts of its step.
#pragma once

#include <optional>
#include <string>

#include "control/arm.h"
#include "control/dig_plan.h"
#include "control/operator.h"

namespace navvy::control {

enum class Phase : int {
  kIdle,
  kDrive,
  kReturn,
  kApproach,
  kPenetrate,
  kDrag,
  kCurl,
  kLift,
  kSwing,
  kDump,
  kWait,
  kTrajectory
};

/// Everything that changes while a program runs; plain values, so saving and hashing are one loop.
struct Memory {
  int step = 0;
  int phase = 0;
  int cycles = 0;
  int empty_scoops = 0;
  int begun = 0;          ///< the present step has been set up
  double phase_time = 0;  ///< [s] since the phase began
  // Commanded angles: swing, boom, stick, bucket; known once read from the machine.
  double q[4] = {0, 0, 0, 0};
  int known = 0;
  // Move in joint space.
  double from[4] = {0, 0, 0, 0}, to[4] = {0, 0, 0, 0};
  double duration = 0;
  // Tip path of the scoop.
  double reach = 0, height = 0, angle = 0;
  double lift = 0;  ///< raised by so much because it stalled [m]
  double slow = 1;  ///< share of the path's speed that the machine follows
  double scoop_start = 0, scoop_end = 0, scoop_level = 0, curl_from = 0;
  // Drive.
  double speed = 0, goal_x = 0, goal_y = 0, heading = 0, standing = 0;
};

struct Operator::State {
  State(const scene::Machine& machine_in, const scene::Program& program_in);

  const scene::Machine machine;
  const scene::Program program;
  std::optional<Arm> arm;
  DigPlan plan;
  Memory m;
  CycleEvent event = CycleEvent::kNone;
  std::string phase_name = "idle";

  // One call of the running step; true when it has ended.
  bool run(const scene::DriveTo& step, const Observation& seen, double dt, Command& out);
  bool run(const scene::Dig& step, const Observation& seen, double dt, Command& out);
  bool run(const scene::Swing& step, const Observation& seen, double dt, Command& out);
  bool run(const scene::Dump& step, const Observation& seen, double dt, Command& out);
  bool run(const scene::Wait& step, const Observation& seen, double dt, Command& out);
  bool run(const scene::Trajectory& step, const Observation& seen, double dt, Command& out);

  void enter(Phase phase);
  Phase phase() const { return static_cast<Phase>(m.phase); }
  void read_arm(const Observation& seen);
  void command_arm(Command& out) const;
  /// Starts a move to these angles (swing, boom, stick, bucket) at `share` of the usual rates.
  void start_move(const std::array<double, 4>& to, const Observation& seen, double share = 1);
  /// Goes on with the move; true when it has arrived, or has had two seconds more than it needs.
  bool move(const Observation& seen);
  Pose swing_frame(const Observation& seen) const { return seen.X_WB * arm->X_BS(); }
  std::array<double, 4> with_arm(double swing, const ArmAngles& q) const { return {swing, q[0], q[1], q[2]}; }

  // Phases of a dig cycle; each is called once per control step while it lasts.
  void begin_scoop(const scene::Dig& dig, const Observation& seen);
  bool plan_scoop(const scene::Dig& dig, const Observation& seen);
  void follow_tip(const Observation& seen, double dt);
  void penetrate(const Observation& seen, double dt);
  void drag(const scene::Dig& dig, const Observation& seen, double dt);
  void curl(const scene::Dig& dig, const Observation& seen, double dt);
  void start_lift(const scene::Dig& dig, const Observation& seen);
  void start_swing(const scene::Dig& dig, const Observation& seen);
  void start_dump(const Observation& seen);
  bool dumped(const Observation& seen) const;
  double path_height(const Observation& seen, double reach, double level) const;
};

}  // namespace navvy::control
