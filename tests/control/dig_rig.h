// SPDX-License-Identifier: Apache-2.0
// An operator in a closed loop with the kinematic engine and a purely geometric soil: soil swept by
// the bucket's shell leaves the ground and fills the bucket, and soil in an opened bucket falls
// below it.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "control/activities/dig/dig.h"
#include "control/operator.h"
#include "core/saved_state.h"
#include "vehicle/physics_engine.h"

namespace navvy::control::testing {

/// The trench of scenarios/trench.sdf: 7.6 m to 4.4 m ahead of the swing axis of a machine at (-4,
/// 0).
Dig trench();

/// Flat ground of loam, 24 x 20 m about the origin, 4 m deep; `cohesion` [Pa].
heightfield::Ground flat_ground(double cell = 0.1, double cohesion = scene::Soil().cohesion);

class DigRig {
 public:
  DigRig(scene::Machine machine, scene::Program program, const Pose& X_WM,
         const Planners& planners = {});

  /// Advances by one control step of 5 ms.
  void step();
  /// Runs until the program ends; returns false after `limit` [s].
  bool run(double limit);

  struct Cycle {
    double start = 0, lift_out = 0, dump = 0, end = 0;  ///< [s]
    double payload = 0;                                 ///< at lift-out [kg]
    double spilt = 0;                                   ///< between lift-out and dump [kg]
  };
  std::vector<Cycle> cycles;
  double time = 0;
  /// Largest change of a joint's target in a step, relative to its speed limit x step.
  double fastest_jump = 0;
  /// Largest deviation of the bucket from its carrying angle between lift-out and dump [rad].
  double worst_tilt = 0;
  heightfield::Ground ground;
  std::unique_ptr<vehicle::PhysicsEngine> engine;
  Operator op;
  /// While the tip is inside this box of the swing plane (W x range, below z), boom, stick and
  /// bucket are blocked.
  double rock_from = 0, rock_to = 0, rock_top = -100;
  bool hit_rock = false;
  /// Soil so strong that a thicker slice blocks the bucket as rock does [m].
  double thickest_slice = 100;
  /// True: what is poured out of the bucket fills the bed of a truck, whose load the operator sees.
  bool fills_bed = false;
  double poured = 0;  ///< [kg]
  /// The bed that the operator sees of a truck of any name, except for its load; nothing: no truck.
  std::optional<BedView> bed;
  /// Centre of the soil in that bed in W (x, y), if the operator can see it.
  std::optional<Vec2> load_centre;
  /// Offset in W [m] from the bucket's tip of what it pours into the bed; with it the operator
  /// sees the centre of what has been poured.
  std::optional<Vec2> lands_off;
  /// Force of the soil on the bucket that the operator feels [N].
  double felt = 0;
  /// Soil in the mouth of the bucket while it is lowered, counted as load [kg].
  double in_mouth = 0;
  /// A loose body on the ground. The bucket takes it up when its edge passes below it, and drops it
  /// when it opens.
  struct Stone {
    BodyView body;
    /// True if the bucket pushes it aside instead.
    bool slips = false;
    /// True while it is in the bucket, at this place in the frame of the bucket's link.
    bool held = false;
    Vec3 p_B = Vec3::Zero();
  };
  std::vector<Stone> stones;
  /// Largest angle of the line from pin to tip at the start of a curl [rad].
  double steepest_curl = -kPi;
  /// Largest drop of the bucket's pin in a curl [m].
  double deepest_curl = 0;
  /// Until this time [s] the operator sees the machine level, and from then on its actual attitude:
  /// ground that yielded.
  double settled_at = 0;
  /// Soil that the bucket loses while it is lifted, and for how long after the start of the lift.
  double leak_rate = 0, leak_time = 0;    // [kg/s], [s]
  double lift_since = -1, dry_since = 0;  ///< when the last lift and its leak began and ended [s]

  void visit(Archive& a);
  std::uint64_t digest() const { return hash_of(*this).digest(); }

 private:
  Observation look() const;
  void note(CycleEvent event, const Observation& seen);
  bool against_rock(const Command& command) const;
  void sweep(const Pose& X_WB);
  void pour(const Pose& X_WB);
  void leak(const Pose& X_WB);
  void carry_stones(const Pose& X_WB);
  void drop(const Vec2& around, double radius, double mass);

  scene::Machine machine_;
  std::vector<double> target_;
  double payload_ = 0;
  Vec2 moment_ = Vec2::Zero();  ///< mass x place of what has been poured into the bed [kg m]
  double capacity_ = 0;
  bool stalled_ = false;
  bool carrying_ = false;
  bool lifting_ = false;
  bool curling_ = false;
  double pin_ = 0;  // height of the bucket's pin before the last curl [m]
};

/// Final ground minus initial ground, compared with the design.
struct TrenchMeasure {
  /// Removed volume relative to the design volume.
  double removed_share = 0;
  /// Volume removed below the floor or beside the outline within 1.5 m, relative to the design
  /// volume.
  double overdug_share = 0;
  /// Share of the length with the floor within 0.10 m.
  double floor_share = 0;
  double center_offset = 0;  ///< [m]
  double removed = 0;        ///< [m3]
};
TrenchMeasure measure(const heightfield::Ground& ground, const Dig& dig);

}  // namespace navvy::control::testing
