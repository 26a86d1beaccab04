// SPDX-License-Identifier: Apache-2.0
// Private to the dig: the activity that carries it out.
#pragma once

#include "control/activities/dig/dig.h"
#include "control/activities/dig/dig_plan.h"
#include "control/activity.h"
#include "control/arm_move.h"
#include "control/stance.h"
#include "control/tip_path.h"

namespace navvy::control {

/// State of a dig beside its plan.
struct DiggingMemory {
  ArmMove move;
  Stance stance;
  TipPath tip;
  /// Number of cycles when the dig began.
  std::int64_t first_cycle = 0;
  std::int64_t empty_scoops = 0;
  std::int64_t clean_ups = 0;
  /// 1 when the scoop is a pass along the whole floor.
  std::int64_t cleaning = 0;
  /// Scoop::start, end and level [m].
  double scoop_start = 0, scoop_end = 0, scoop_level = 0;
  /// Scoop::soil [m].
  double soil_start = 0;
  /// Position of the tip along the trench, from its near end [m].
  double s = 0;
  /// Progress of the curl, 0 to 1.
  double progress = 0;
  /// Angle [rad] and height [m] of the tip path when the curl began.
  double curl_angle = 0, curl_z = 0;
  /// Bank volume [m3] and mass [kg] of a full bucket.
  double scoop_volume = 0, full_mass = 0;
  /// Lift of the tip path when the drag began [m].
  double lift_before = 0;
  /// Integral over the drag's length of the lift that soil has caused since [m2].
  double held_up = 0;
  /// Payload after the lift when it last fell [kg], and the time of that [s].
  double held = 0, held_since = 0;

  void visit(Archive& a);
};

/// The digging cycle: return, approach, penetrate, drag, curl, lift, swing, dump, until the plan
/// finds nothing more; then a last look at the trench. digging.cpp holds the sequence, scoop.cpp
/// the tip's paths through the soil.
class Digging final : public ActivityWith<DiggingMemory> {
 public:
  Digging(OperatorContext& place, const Dig& dig)
      : ActivityWith(place), dig_(dig), arm_(*place.arm) {}

  /// Takes the machine's stance and the original surface, and moves to the first scoop.
  void begin(const Observation& seen) override;
  const char* phase() const override;
  /// Returns cycles, design volume and what is left of it, commanded and reached depth.
  std::vector<Measurement> account(const Observation& seen) const override;
  /// Visits memory and plan.
  void visit(Archive& a) override;

 private:
  // In the order of a cycle; kLook ends the dig.
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

  bool update(const Observation& seen, double dt, Command& out) override;

  /// Asks the plan for the next scoop; returns false when the dig has come to its end.
  bool plan_scoop(const Observation& seen);
  /// Moves the open bucket over the scoop's start. Called twice per cycle: high, then down once the
  /// swing has come to rest.
  void go_to_scoop(Phase next, const Observation& seen);
  /// Continues with the next scoop, or with a last look before the end.
  void go_on(Phase next, const Observation& seen);
  /// Makes the next slices thinner after a drag that the soil held up.
  void thin_slices();
  /// Starts to level the bucket and lift it clear of the trench's edges.
  void start_lift(const Observation& seen);
  /// Returns true while the lifted bucket still loses soil over the trench.
  bool drips(const Observation& seen);
  /// Starts the swing over the heap, high enough for it, gently with a full bucket.
  void start_swing(const Observation& seen);
  void start_dump(const Observation& seen);
  /// Continues the dump; returns true when the bucket is empty, or will not get emptier.
  bool dump(const Observation& seen);
  /// Strokes the bucket cylinder while soil sticks.
  void shake(const Observation& seen);
  /// Moves the bucket aside and pauses, before the trench counts as done.
  void look_round(const Observation& seen);
  /// Decides after the pause: another scoop (false), or the end (true).
  bool end_cycle(const Observation& seen);
  /// Returns true when the scoop's start is out of reach from where the machine stands now.
  bool beyond_reach(const Scoop& scoop) const;
  /// Reports why there is no other scoop. Always returns true.
  bool conclude(const Observation& seen);
  /// Returns the number of cycles of this dig.
  std::int64_t cycles() const { return place_.handover.cycles - m.first_cycle; }
  bool move(const Observation& seen) { return m.move.advance(place_, seen, phase_time(), phase()); }

  // Tip paths in the vertical plane of the trench. Each moves the wanted tip by one control step;
  // drag and curl return true when they are done.
  void penetrate(const Observation& seen, double dt);
  bool drag(const Observation& seen, double dt);
  bool curl(const Observation& seen, double dt);
  void follow_tip(const Observation& seen, double dt);
  /// Returns the height [m] in W at which the tip must move so that no part of the bucket goes
  /// below the slice.
  double floor_height() const;
  /// Returns true, and warns, when the phase has lasted longer than `limit` [s].
  bool overdue(double limit) const;

  const Dig& dig_;
  const ArmKinematics& arm_;
  DigPlan plan_;
};

}  // namespace navvy::control
