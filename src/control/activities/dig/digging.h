// SPDX-License-Identifier: Apache-2.0
// The activity that carries out a dig step. Private to the dig.
#pragma once

#include "control/activities/dig/dig.h"
#include "control/activities/dig/dig_plan.h"
#include "control/activities/dig/landing.h"
#include "control/activity.h"
#include "control/arm_move.h"
#include "control/stance.h"
#include "control/tip_path.h"

namespace navvy::control {

/// State of a dig, except its plan.
struct DiggingMemory {
  /// Current move of the arm between two poses.
  ArmMove move;
  /// Filtered pose of the chassis.
  Stance stance;
  /// Path of the bucket's tip through the soil.
  TipPath tip;
  /// Number of cycles that the program had completed when the dig began.
  std::int64_t first_cycle = 0;
  /// Number of empty scoops since the last one that brought soil.
  std::int64_t empty_scoops = 0;
  /// Number of cleaning passes along the floor so far.
  std::int64_t clean_ups = 0;
  /// 1 if the current scoop is a cleaning pass along the whole floor, else 0.
  std::int64_t cleaning = 0;
  /// Current scoop: Scoop::start, Scoop::end and Scoop::level [m].
  double scoop_start = 0, scoop_end = 0, scoop_level = 0;
  /// Current scoop: Scoop::soil [m].
  double soil_start = 0;
  /// Commanded position of the tip along the trench, from the near end [m].
  double s = 0;
  /// Progress of the curl, from 0 to 1 [-].
  double progress = 0;
  /// `curl_angle` [rad] and `curl_z` [m] are the angle and the height in W of the tip path when the
  /// curl began.
  double curl_angle = 0, curl_z = 0;
  /// Bank volume (`scoop_volume` [m3]) and mass (`full_mass` [kg]) of the soil in a bucket that
  /// counts as full.
  double scoop_volume = 0, full_mass = 0;
  /// TipPath::lift when the drag began [m].
  double lift_before = 0;
  /// Integral of the additional lift since then over the distance dragged [m2].
  double held_up = 0;
  /// `held` is the payload when it last decreased during the lift phase [kg], and `held_since` the
  /// phase time at that moment [s]. They show whether soil still falls from the bucket.
  double held = 0, held_since = 0;

  /// Saves or loads all fields.
  void visit(Archive& a);
};

/// Activity that carries out a dig: return, approach, penetrate, drag, curl, lift, swing, dump, and
/// again, until the plan has no further scoop; then a final look at the trench. digging.cpp
/// implements the sequence of phases, and scoop.cpp the paths of the tip through the soil.
class Digging final : public ActivityWith<DiggingMemory> {
 public:
  /// Makes the activity of the step `dig`. The step and `place` must outlive it; `place` must have
  /// an arm.
  Digging(OperatorContext& place, const Dig& dig)
      : ActivityWith(place), dig_(dig), arm_(*place.arm), landing_(dig.into) {}

  /// Records the machine's pose and the original surface, and starts the move to the first scoop.
  void begin(const Observation& seen) override;
  /// Returns the name of the current phase.
  const char* phase() const override;
  /// Returns the number of cycles, the commanded volume and the part of it that is left, and the
  /// commanded and the reached depth.
  std::vector<Measurement> account(const Observation& seen) const override;
  /// Saves or loads the state and the plan.
  void visit(Archive& a) override;

 private:
  // Phases in the order of a cycle; kLook is the final look at the trench.
  enum Phase : std::int64_t {
    kReturn,
    kApproach,
    kPenetrate,
    kDrag,
    kCurl,
    kLift,
    kSwing,
    kDump,
    kLook
  };

  /// Advances the current phase by one control step. Returns true when the dig is over.
  bool update(const Observation& seen, double dt, Command& out) override;

  /// Selects the next scoop. Returns false if there is none, or if a limit on cycles or empty
  /// scoops is reached.
  bool plan_scoop(const Observation& seen);
  /// Starts the move of the open bucket to the start of the scoop, and enters the phase `next`.
  /// This happens twice per cycle: in the phase kReturn the bucket stays high; in kApproach it
  /// comes down after the swing has stopped.
  void go_to_scoop(Phase next, const Observation& seen);
  /// Selects the next scoop and moves to it in the phase `next`, or starts the final look if there
  /// is no further scoop.
  void go_on(Phase next, const Observation& seen);
  /// Makes the following slices thinner if the soil held the bucket during the last drag.
  void thin_slices();
  /// Starts the move that levels the bucket and lifts it clear of the trench's edges.
  void start_lift(const Observation& seen);
  /// Returns true while soil still falls from the lifted bucket into the trench.
  bool drips(const Observation& seen);
  /// Starts the swing to the dump point. The bucket is raised enough to clear the heap; a full
  /// bucket swings more slowly.
  void start_swing(const Observation& seen);
  /// Starts to open the bucket.
  void start_dump(const Observation& seen);
  /// Continues the dump. Returns true when the bucket is empty, or when waiting longer is no use.
  bool dump(const Observation& seen);
  /// Shakes the bucket with its cylinder while soil sticks to it.
  void shake(const Observation& seen);
  /// Moves the bucket aside and waits for loose soil to come to rest, before the trench counts as
  /// done.
  void look_round(const Observation& seen);
  /// Continues the final look. Returns false while it lasts or if there is a further scoop, and
  /// true if the dig is over.
  bool end_cycle(const Observation& seen);
  /// Returns true if the start of the scoop is out of reach from the machine's current position.
  bool beyond_reach(const Scoop& scoop) const;
  /// Ends the dump of the last cycle. Returns true, with the step failed, if its soil has not
  /// landed in the receiver.
  bool falls_short_of_receiver(const Observation& seen);
  /// Sets the final state of the step and the reason why there is no further scoop. Always returns
  /// true.
  bool conclude(const Observation& seen);
  /// Returns the number of cycles that this dig has completed.
  std::int64_t cycles() const { return place_.handover.cycles - m.first_cycle; }
  /// Continues the current move of the arm. Returns true when the move is over.
  bool move(const Observation& seen) { return m.move.advance(place_, seen, phase_time(), phase()); }

  /// Moves the tip down into the soil, and enters the drag when it is deep enough.
  void penetrate(const Observation& seen, double dt);
  /// Drags the bucket towards the machine. Returns true when the bucket is full or the scoop has
  /// ended.
  bool drag(const Observation& seen, double dt);
  /// Curls the bucket out of the ground. Returns true when the curl is over.
  bool curl(const Observation& seen, double dt);
  /// Commands the arm to follow the tip path, which the phase has updated before.
  void follow_tip(const Observation& seen, double dt);
  /// Returns the lowest allowed height of the tip in W [m], at which no part of the bucket is below
  /// the slice.
  double floor_height() const;
  /// Returns true and logs a warning if the current phase has lasted longer than `limit` [s].
  bool overdue(double limit) const;

  // The step that is carried out.
  const Dig& dig_;
  // Kinematics of the machine's arm.
  const ArmKinematics& arm_;
  // Plan of the trench, made in `begin`.
  DigPlan plan_;
  // Soil that lands in the receiver.
  Landing landing_;
};

}  // namespace navvy::control
