// SPDX-License-Identifier: Apache-2.0
// Private to the operator: its memory and the parts of its step.
#pragma once

#include <cstddef>
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
  kLook,
  kWait,
  kTrajectory,
  kTip,
  kWaitFor
};

/// Everything that changes while a program runs; plain values without gaps, so saving and hashing take them whole.
struct Memory {
  int step = 0;
  int phase = 0;
  int cycles = 0;
  int empty_scoops = 0;
  int begun = 0;  ///< the present step has been set up
  int known = 0;  ///< `q` was read from the machine
  int clean_ups = 0;
  int cleaning = 0;       ///< the scoop is a pass along the whole floor
  int closing = 0;        ///< a dump step curls back
  int first_cycle = 0;    ///< number of cycles when the dig began
  double phase_time = 0;  ///< [s] since the phase began
  // Swing, boom, stick, bucket: commanded angles; a move between two poses, each axis with its own smooth profile.
  double q[4] = {0, 0, 0, 0}, from[4] = {0, 0, 0, 0}, to[4] = {0, 0, 0, 0};
  double swing_time = 0, arm_delay = 0, arm_time = 0;  ///< [s]
  // Tip path of the scoop: place along the trench, W height, angle of the line pin to tip over the horizontal.
  double s = 0, z = 0, angle = 0;
  double reached = 0;   ///< the angle that the arm can give there
  double lift = 0;      ///< the path is raised by so much because the machine stalled [m]
  double slow = 1;      ///< share of the path's speed that the machine follows
  double stall = 0;     ///< [s] that the tip has been held
  double progress = 0;  ///< of the curl, 0..1
  double scoop_start = 0, scoop_end = 0, scoop_level = 0, curl_angle = 0, curl_z = 0;
  double scoop_volume = 0, full_mass = 0;  ///< of a full bucket: bank volume [m3], mass [kg]
  double held = 0, held_since = 0;         ///< payload after the lift when it last fell [kg], and when [s]
  double bucket_before = 0;                ///< bucket angle before a dump step [rad]
  double base[7] = {0, 0, 0, 1, 0, 0, 0};  ///< base link's pose, shaking smoothed away: x y z, quaternion w x y z
  double up[3] = {0, 0, 1};                ///< the base's z axis in W when the dig began
  // Drive.
  double speed = 0, heading = 0, standing = 0, way = 0;  // `standing` also: [s] that the bed has been where it is told
};
static_assert(offsetof(Memory, phase_time) == 10 * sizeof(int), "no gap before the doubles");

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
  bool run(const scene::Tip& step, const Observation& seen, double dt, Command& out);
  bool run(const scene::WaitFor& step, const Observation& seen, double dt, Command& out);
  bool run(const scene::Trajectory& step, const Observation& seen, double dt, Command& out);

  void enter(Phase phase);
  Phase phase() const { return static_cast<Phase>(m.phase); }
  /// Joint of axis 0..3: swing, boom, stick, bucket.
  std::size_t axis_joint(std::size_t axis) const;
  void read_arm(const Observation& seen);
  void command_arm(Command& out) const;

  // Moves in joint space.
  struct Pace {
    double share = 1;      ///< of the usual rates
    double arm_delay = 0;  ///< boom, stick and bucket start when this share of the swing's time is over
  };
  void start_move(const std::array<double, 4>& to, const Observation& seen, Pace pace);
  /// Goes on with the move; true when it has arrived, or has had its time and a little patience.
  bool move(const Observation& seen);
  double move_time() const;
  ArmAngles arm_now() const { return {m.q[1], m.q[2], m.q[3]}; }
  std::array<double, 4> with_arm(double swing, const ArmAngles& q) const;

  // The dig: see dig_cycle.cpp (sequence) and scoop.cpp (tip paths).
  void begin_dig(const scene::Dig& dig, const Observation& seen);
  bool plan_scoop(const scene::Dig& dig, const Observation& seen);
  void go_to_scoop(Phase next, const Observation& seen);
  /// To the next scoop, or to a look round before the end.
  void go_on(const scene::Dig& dig, Phase next, const Observation& seen);
  void start_lift(const Observation& seen);
  /// Whether the lifted bucket still loses soil over the trench.
  bool drips(const Observation& seen);
  void start_swing(const scene::Dig& dig, const Observation& seen);
  void start_dump(const Observation& seen);
  bool dumped(const Observation& seen) const;
  void shake(const Observation& seen);
  void look_round(const Observation& seen);
  bool end_cycle(const scene::Dig& dig, const Observation& seen);

  void smooth_base(const Observation& seen, double dt, bool reset);
  Pose swing_frame() const;
  void penetrate(const Observation& seen, double dt);
  bool drag(const Observation& seen, double dt);
  bool curl(const Observation& seen, double dt);
  void follow_tip(const Observation& seen, double dt);
  /// 1 while the machine stands as it did when the dig began, 0 when the bucket tips it.
  double footing(const Observation& seen) const;
  void feel_stall(const Observation& seen, const BucketPose& wanted, double dt);
  bool overdue(double limit) const;
  double floor_height() const;
};

}  // namespace navvy::control
