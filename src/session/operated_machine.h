// SPDX-License-Identifier: Apache-2.0
// A machine whose program is carried out by an operator. Private to the session.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "control/operator.h"
#include "core/archive.h"
#include "heightfield/terrain_view.h"
#include "session/bucket_gauge.h"
#include "session/reports.h"
#include "sim/world.h"

namespace navvy::session {

/// The terrain as an operator sees it from its cab: columns and the loose soil on them.
///
/// Takes one view in each step in which it is used, so a snapshot need not contain it. A view costs
/// a pass over the particles.
class SeenSurface final : public control::SurfaceView {
 public:
  /// Keeps a reference to `world`, which must outlive this object.
  explicit SeenSurface(const sim::World& world) : world_(world) {}
  /// Returns the terrain of the present step, valid until the next step.
  const heightfield::Terrain& terrain() const override;
  /// Returns a new view of the surface that maps show.
  heightfield::TerrainView mapped() const override;
  /// Drops the view: the world was put into another state.
  void forget() { view_.reset(); }

 private:
  const sim::World& world_;
  mutable std::optional<heightfield::TerrainView> view_;
  mutable std::uint64_t seen_step_ = 0;
};

/// A machine, its operator, and the digging cycle and bed tip that have begun and not ended.
class OperatedMachine {
 public:
  /// State of all programs by machine name, as it was when the step began.
  using Programs = std::map<std::string, control::ProgramProgress>;

  /// Makes the operator of machine `machine` (index in the scene). `surface` and `programs` are
  /// shared by all operators; references must stay valid. `planners` is asked for a path planner if
  /// a step needs one.
  OperatedMachine(sim::World& world, int machine, const SeenSurface& surface,
                  const Programs& programs, const control::MakePathPlanner& planners);

  /// Index of the machine in the scene.
  int index() const { return machine_.index(); }
  const std::string& name() const { return machine_.name(); }
  /// Returns the operator, which knows how its program stands.
  const control::Operator& op() const { return op_; }
  /// Returns true if inputs drive the machine, so that its program no longer commands it.
  bool taken() const { return taken_; }
  /// Returns true while the program commands the machine and has not ended.
  bool busy() const { return !taken_ && !op_.ended(); }

  /// Lets the operator observe and command the machine for one step. Appends cycles and tips that
  /// end. Does nothing once the machine is taken.
  void step(std::vector<Cycle>& cycles, std::vector<BedTip>& tips);
  /// Takes the machine from its program for good and stops what the program had set in motion.
  /// Returns true the first time.
  bool take();
  /// Returns how the program stands. Costs a view of the surface if the report of a step needs one.
  ProgramReport report() const;

  /// Visits all state that determines later commands and reports.
  void visit(Archive& a);

 private:
  /// Fills what a cab shows: joint positions, stance, the force on the bucket and its payload.
  void observe(control::Observation& seen) const;
  /// Forwards the commands that changed to the world.
  void send(const control::Command& command);
  /// Updates the open cycle and appends it when it ends.
  void note_cycle(std::vector<Cycle>& cycles);
  /// Updates the open bed tip and appends it when it ends.
  void note_tip(std::vector<BedTip>& tips);

  sim::World& world_;
  sim::MachineHandle machine_;
  /// Handles to observe the machine: all joints and wheels, the first bucket, the first bed.
  std::vector<sim::JointHandle> joints_;
  std::vector<sim::WheelHandle> wheels_;
  std::optional<BucketGauge> bucket_;
  std::optional<sim::ToolHandle> bed_;
  // The operator holds its own state; the observation of the last step is kept beside it.
  control::Operator op_;
  control::Observation seen_;
  // Begun and not ended.
  std::optional<Cycle> open_;
  std::optional<BedTip> open_tip_;
  /// True once inputs took the machine.
  bool taken_ = false;
};

}  // namespace navvy::session
