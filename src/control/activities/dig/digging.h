// SPDX-License-Identifier: Apache-2.0
// Private to the dig: what carries it out.
#pragma once

#include "control/activities/dig/dig.h"
#include "control/activities/dig/dig_plan.h"
#include "control/activity.h"
#include "control/arm_move.h"
#include "control/stance.h"
#include "control/tip_path.h"

namespace navvy::control {

/// Everything that changes while a trench is dug, beside the plan.
struct DiggingMemory {
  ArmMove move;
  Stance stance;
  TipPath tip;
  std::int64_t first_cycle = 0;  ///< number of cycles when the dig began
  std::int64_t empty_scoops = 0;
  std::int64_t clean_ups = 0;
  /// 1: the scoop is a pass along the whole floor.
  std::int64_t cleaning = 0;
  double scoop_start = 0, scoop_end = 0, scoop_level = 0;  ///< as in Scoop [m]
  double soil_start = 0;                                   ///< Scoop::soil [m]
  /// The tip's place along the trench, from its near end [m].
  double s = 0;
  double progress = 0;  ///< of the curl, 0..1
  /// Of the tip path when the curl began [rad], [m].
  double curl_angle = 0, curl_z = 0;
  /// Of a full bucket: bank volume [m3], mass [kg].
  double scoop_volume = 0, full_mass = 0;
  /// Of the tip path when the drag began [m].
  double lift_before = 0;
  /// What soil has raised it by since, over the length of the drag [m2].
  double held_up = 0;
  double held = 0, held_since = 0;  ///< payload after the lift when it last fell [kg], and when [s]

  void visit(Archive& a);
};

/// The digging cycle: return, approach, penetrate, drag, curl, lift, swing, dump, until the plan
/// finds nothing more; then a look round. digging.cpp has the sequence, scoop.cpp the tip's paths
/// through the soil.
class Digging final : public ActivityWith<DiggingMemory> {
 public:
  Digging(OperatorContext& place, const Dig& dig)
      : ActivityWith(place), dig_(dig), arm_(*place.arm) {}

  /// Takes how the machine stands and the surface before the dig, and goes to the first scoop.
  void begin(const Observation& seen) override;
  const char* phase() const override;
  /// Cycles, design volume and what is left of it, depth asked for and reached.
  std::vector<Measurement> account(const Observation& seen) const override;
  /// Memory and plan.
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

  // Sequence.
  /// Asks the plan for the next scoop; false when the dig has come to its end.
  bool plan_scoop(const Observation& seen);
  /// Moves the open bucket over the scoop's start. Twice a cycle: high, then down when the swing
  /// has come to rest.
  void go_to_scoop(Phase next, const Observation& seen);
  /// To the next scoop, or to a look round before the end.
  void go_on(Phase next, const Observation& seen);
  /// After a drag that the soil held up: the next slices are thinner.
  void thin_slices();
  /// Level and up, clear of the trench's edges.
  void start_lift(const Observation& seen);
  /// Whether the lifted bucket still loses soil over the trench.
  bool drips(const Observation& seen);
  /// Over the heap, high enough for it, gently with a full bucket.
  void start_swing(const Observation& seen);
  void start_dump(const Observation& seen);
  /// Goes on with the dump; true when the bucket is empty, or will not get emptier.
  bool dump(const Observation& seen);
  /// Strokes of the bucket cylinder while something sticks.
  void shake(const Observation& seen);
  /// Bucket aside and a pause, before the trench counts as done.
  void look_round(const Observation& seen);
  /// After the pause: another scoop (false), or the end (true).
  bool end_cycle(const Observation& seen);
  /// Whether the scoop's start is beyond the arm, from where the machine stands now; the bucket
  /// would stay short of it.
  bool beyond_reach(const Scoop& scoop) const;
  /// Why there is no other scoop. Always true.
  bool conclude(const Observation& seen);
  /// Made in this dig.
  std::int64_t cycles() const { return place_.handover.cycles - m.first_cycle; }
  bool move(const Observation& seen) { return m.move.advance(place_, seen, phase_time(), phase()); }

  // Tip paths in the vertical plane of the trench.
  // Each moves the wanted tip by one control step; drag and curl tell when they are done.
  void penetrate(const Observation& seen, double dt);
  bool drag(const Observation& seen, double dt);
  bool curl(const Observation& seen, double dt);
  void follow_tip(const Observation& seen, double dt);
  /// How high the tip rides so that no part of the bucket goes below the slice [m] in W.
  double floor_height() const;
  /// Whether the phase has lasted longer than `limit` [s]; says so.
  bool overdue(double limit) const;

  const Dig& dig_;
  const ArmKinematics& arm_;
  DigPlan plan_;
};

}  // namespace navvy::control
