// SPDX-License-Identifier: Apache-2.0
// The activity that carries out a dig step. Private to the dig.
#pragma once

#include "control/activities/dig/dig.h"
#include "control/activities/dig/dig_plan.h"
#include "control/activities/dig/landing.h"
#include "control/activities/dig/trim.h"
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
  /// Load of the last cleaning pass, in a cut of the last scoop [kg].
  double cleaned = 0;
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
  /// 1 if that soil is cohesionless (is_cohesionless in fill.h), else 0.
  std::int64_t cohesionless = 0;
  /// Mass that the current scoop shall bring when a bed is loaded to a stated mass [kg].
  double wanted = 0;
  /// Mass that a scoop brought / payload at which its curl was to begin [-]; learned from all
  /// scoops.
  double gain = 1;
  /// TipPath::lift when the drag began [m].
  double lift_before = 0;
  /// Integral of the additional lift since then over the distance dragged [m2].
  double held_up = 0;
  /// 1 if something in the ground held the last drag, else 0.
  std::int64_t hindered = 0;
  /// Height in W of the ground under the start of the scoop [m].
  double ground = 0;
  /// Height in W that the bucket must have left below it before the machine swings [m].
  double edge = 0;
  /// `held` is the payload when it last decreased noticeably during the lift phase [kg], and
  /// `held_since` the phase time at that moment [s]. They show whether soil still falls from the
  /// bucket.
  double held = 0, held_since = 0;
  /// Times after the start of the carry move at which the swing and the dump began [s].
  double lifted = 0, opened = 0;

  /// Saves or loads all fields.
  void visit(Archive& a);
};

/// Activity that carries out a dig: return, approach, penetrate, drag, curl, lift, swing, dump, and
/// again, until the plan has no further scoop; then a final look at the trench. digging.cpp
/// implements the sequence of phases, and scoop.cpp the paths of the tip through the soil.
///
/// Lift, swing and dump are one move of the arm. It lifts from the ground on, the machine swings as
/// soon as the bucket is clear of the edges, and the bucket opens shortly before it arrives.
class Digging final : public ActivityWith<DiggingMemory> {
 public:
  /// Makes the activity of the step `dig`. The step and `place` must outlive it; `place` must have
  /// an arm.
  Digging(OperatorContext& place, const Dig& dig)
      : ActivityWith(place), dig_(dig), arm_(*place.arm), plan_(dig), landing_(dig.into) {}

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
  // Bounds of the mass of a scoop / the mass that it aims at: a scoop that met rock teaches
  // nothing.
  static constexpr double kLeastGain = 0.8, kMostGain = 1.25;

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
  /// Divides what a bed lacks [kg] into equal passes and sets the mass of the next one.
  void aim_at(double lack);
  /// Starts the move of the open bucket to the start of the scoop, and enters the phase `next`. In
  /// the phase kReturn the bucket stays above the edges; in kApproach, after the swing, it moves to
  /// a start that the ground seen from there has moved far along the trench.
  void go_to_scoop(Phase next, const Observation& seen);
  /// Selects the next scoop on the ground as it is seen after the return, and starts it or moves to
  /// it first; starts the final look if there is none.
  void arrive(const Observation& seen);
  /// Selects the next scoop and moves to it in the phase `next`, or starts the final look if there
  /// is no further scoop.
  void go_on(Phase next, const Observation& seen);
  /// Makes the following slices thinner if the soil held the bucket during the last drag.
  void thin_slices();
  /// Returns the position of the swing joint at which the bucket is over a place, `swing` or whole
  /// turns from it, `out` from the swing axis in W [m]: on the shorter arc, or, behind the machine,
  /// on that which comes over the tail of a bed and not over the cab.
  double arc_to(double swing, const Vec2& out) const;
  /// Starts the move from the ground to the dump point, with the swing held. The bucket is raised
  /// enough to clear the heap there.
  void start_carry(const Observation& seen);
  /// Continues the carry move until the machine may swing. Returns true then: the bucket is clear
  /// of the trench's edges, will be up before it gets to the heap, and loses no more soil.
  bool lift(const Observation& seen);
  /// Lets what a bed does not need fall back, once the bucket is up. Returns true while it does.
  bool trims(const Observation& seen, double dt);
  /// Returns true while soil still falls from the lifted bucket into the trench.
  bool drips(const Observation& seen);
  /// Returns the measured pose of the bucket.
  BucketPose bucket_pose(const Observation& seen) const;
  /// Returns true if the bucket's lowest point is above the height `z` in W [m].
  bool is_above(const Observation& seen, double z) const;
  /// Continues the carry move. Returns true when the swing is so near to its end that the bucket
  /// may open.
  bool swing(const Observation& seen);
  /// Starts to open the bucket while the swing ends.
  void start_dump(const Observation& seen);
  /// Returns true if the load shows that the scoop has met soil that cannot be dug.
  bool met_undiggable(const Observation& seen) const;
  /// Returns true if neither soil that counts nor a body is in the bucket.
  bool is_empty(const Observation& seen) const;
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
  /// Returns the arm's angles at which the bucket is ready to open over `place`, which is moved
  /// nearer or farther where the heap is too high.
  ArmAngles opening_pose(const Observation& seen, const Pose& X_WS, Vec2& place) const;
  /// Returns the height of a heap about `p` in W [m].
  static double heap_at(const Observation& seen, const Vec2& p);
  /// Learns from the payload of a scoop for a bed [kg] how much the curl adds or loses.
  void learn_gain(double payload);
  /// Returns the place (x, y) in W at which the bucket is to open [m].
  Vec2 dump_place(const Observation& seen) const;
  /// Returns the offset in W [m] that moves the next dump into a bed, so that the load's centre
  /// returns to the middle.
  Vec2 off_centre(const Observation& seen) const;
  /// Returns true if the job is to look for another cut.
  bool cut_is_over() const;
  /// Returns the mass that the bed still lacks [kg]; infinity without a stated mass.
  double lacking(const Observation& seen) const;
  /// Returns the payload that counts as full in the drag [kg].
  double aimed_mass() const {
    return dig_.has_load ? std::min(m.wanted, m.full_mass) / m.gain : m.full_mass;
  }
  /// Sets the result of a step that loads a bed. Always returns true.
  bool conclude_load(const Observation& seen);
  /// Returns true if a further cleaning pass is allowed.
  bool may_clean(const Observation& seen) const;
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

  /// Enters the phase kPenetrate at the start of the scoop.
  void start_scoop(const Observation& seen);
  /// Returns true if the swing has come to rest at its commanded angle.
  bool is_aligned(const Observation& seen) const;
  /// Moves the tip down into the soil, and enters the drag when it is deep enough. Small
  /// corrections of the scoop's start happen in the air.
  void penetrate(const Observation& seen, double dt, Command& out);
  /// Drags the bucket towards the machine. Returns true when the bucket is full or the scoop has
  /// ended.
  bool drag(const Observation& seen, double dt, Command& out);
  /// Curls the bucket out of the ground. Returns true when the curl is over.
  bool curl(const Observation& seen, double dt, Command& out);
  /// Commands the arm to follow the tip path, which the phase has updated before.
  void follow_tip(const Observation& seen, double dt, Command& out);
  /// Returns the angle of the cutting edge below the horizontal in the drag [rad]: on a floor that
  /// rises outward so steep that the bucket's body follows in the cut of its edge.
  double attack() const;
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
  // Soil that lands in the receiver, and that which falls back because it holds enough.
  Landing landing_;
  Trim trim_;
};

}  // namespace navvy::control
