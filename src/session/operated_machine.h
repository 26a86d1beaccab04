// SPDX-License-Identifier: Apache-2.0
// A machine whose program an operator carries out. Private to the session.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
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

/// The terrain as operators see it from their cabs: the ground columns and the loose soil on them.
///
/// The surface is computed at the first request in a step, at the cost of one pass over the
/// particles. A snapshot does not contain it.
class SeenSurface final : public control::SurfaceView {
 public:
  /// Stores a reference to `world`, which must outlive this object.
  explicit SeenSurface(const sim::World& world) : world_(world) {}
  /// Returns the terrain in the current step. The reference is valid until the next step.
  const heightfield::Terrain& terrain() const override;
  /// Returns a new copy of the surface as maps show it, without the soil in buckets and beds.
  heightfield::TerrainView mapped() const override;
  /// Discards the computed surface. Call it after the state of the world has been replaced.
  void forget() { view_.reset(); }

 private:
  // The observed world.
  const sim::World& world_;
  // The last computed surface; empty if there is none.
  mutable std::optional<heightfield::TerrainView> view_;
  // Step of the world for which `view_` was computed.
  mutable std::uint64_t seen_step_ = 0;
};

/// The terrain as the operator of one machine sees it: its maps show all bodies but this machine
/// and what it pulls.
class SurfaceAroundMachine final : public control::SurfaceView {
 public:
  /// Stores references to `surface` and `world`, which must outlive this object. `machine` is the
  /// index of the machine in the scene.
  SurfaceAroundMachine(const SeenSurface& surface, const sim::World& world, int machine)
      : surface_(surface), world_(world), machine_(machine) {}
  /// Returns the terrain in the current step.
  const heightfield::Terrain& terrain() const override { return surface_.terrain(); }
  /// Returns a new copy of the surface with the areas of all other bodies.
  heightfield::TerrainView mapped() const override;

 private:
  // Surface that all operators share.
  const SeenSurface& surface_;
  // The observed world, and the index of the machine.
  const sim::World& world_;
  int machine_;
};

/// A machine and its operator. Also records the machine's digging cycle and bed tip while they are
/// in progress.
class OperatedMachine {
 public:
  /// Progress of all programs at the beginning of the step, keyed by machine name.
  using Programs = std::map<std::string, control::ProgramProgress>;

  /// Makes the operator of the machine with the index `machine` in the scene. `surface`, `programs`
  /// and `planners` are shared by all operators; they and `world` must outlive this object.
  /// `planners` makes the planners of paths and of jobs that steps of the program need. @throws
  /// InputError if the machine lacks a part that the program needs, or if a planner that it needs
  /// cannot be made.
  OperatedMachine(sim::World& world, int machine, const SeenSurface& surface,
                  const Programs& programs, const control::Planners& planners);

  /// Returns the index of the machine in the scene.
  int index() const { return machine_.index(); }
  /// Returns the name of the machine in the scene.
  const std::string& name() const { return machine_.name(); }
  /// Returns the operator, for its progress, phase and reports.
  const control::Operator& op() const { return op_; }
  /// Returns true if `take` has been called: inputs drive the machine, and its program no longer
  /// commands it.
  bool taken() const { return taken_; }
  /// Returns true while the program commands the machine and has not ended.
  bool busy() const { return !taken_ && !op_.ended(); }
  /// Returns the progress of the program. Steps that programs completed which orders have replaced
  /// count, so that a machine which waits for them misses none.
  control::ProgramProgress progress() const;
  /// Returns true if the program was ordered, so that another one may follow it.
  bool ordered() const { return orders_ > 0; }
  /// Returns the terrain as the operator sees it.
  const control::SurfaceView& surface() const { return *around_; }

  /// Lets the operator observe and command the machine for one step. Appends a digging cycle or a
  /// bed tip that ends in this step to `cycles` or `tips`. Does nothing after `take`.
  void step(std::vector<Cycle>& cycles, std::vector<BedTip>& tips);
  /// Stops the program until the next order, because inputs drive the machine from now on, and
  /// stops the joints and the drive that the program has commanded. Returns true at the first call
  /// and false afterwards.
  bool take();
  /// Replaces the program by `program`, which was read from `steps`. Stops what a program that
  /// still runs has commanded; after inputs, and for a first program, the arm stops and the drive
  /// brakes. Ends what `take` began. @throws InputError as the constructor does; nothing changes
  /// then.
  void order(const std::string& steps, const scene::Program& program);
  /// Returns the report of the program, after the steps of programs that it replaced. If the
  /// running step needs the surface for its measurements, that costs one pass over the particles.
  ProgramReport report() const;

  /// Saves or loads all state that affects later commands and reports.
  void visit(Archive& a);

 private:
  /// Returns commands that stop the arm and brake the drive.
  control::Command stand() const;
  /// Returns an operator for a program of the machine.
  control::Operator make_operator(const scene::Program& program) const;
  /// Saves or loads the orders, and makes the operator of the loaded one.
  void visit_orders(Archive& a);
  /// Fills in what an operator observes: joint states, pose and stability, and the force on the
  /// bucket and its payload.
  void observe(control::Observation& seen) const;
  /// Connects the functions of the observation that return loads and the state of hitches.
  void connect_gauges();
  /// Passes the new commands to the world. Joints and a drive without a new command keep their last
  /// one.
  void send(const control::Command& command);
  /// Updates the current digging cycle, and appends it to `cycles` when it ends.
  void note_cycle(std::vector<Cycle>& cycles);
  /// Updates the current bed tip, and appends it to `tips` when it ends.
  void note_tip(std::vector<BedTip>& tips);

  // World that the machine is in, and makers of planners.
  sim::World& world_;
  const control::Planners& planners_;
  // The operated machine.
  sim::MachineHandle machine_;
  // All joints of the machine, in the order of its description.
  std::vector<sim::JointHandle> joints_;
  // All wheels of the machine, in the order of its description.
  std::vector<sim::WheelHandle> wheels_;
  // Gauge of the machine's first bucket; empty if it has none.
  std::optional<BucketGauge> bucket_;
  // The terrain around the machine. On the heap, because observations point to it.
  std::unique_ptr<const SurfaceAroundMachine> around_;
  // The machine's first bed; empty if it has none.
  std::optional<sim::ToolHandle> bed_;
  // The operator, with the state of the program.
  control::Operator op_;
  // What the operator observed in the last step.
  control::Observation seen_;
  // Digging cycle in progress; empty if there is none.
  std::optional<Cycle> open_;
  // Bed tip in progress; empty if there is none.
  std::optional<BedTip> open_tip_;
  // True after `take` has been called, until the next order.
  bool taken_ = false;
  // Number of orders, and the steps of the last one as text; empty: the scene's program runs.
  std::int64_t orders_ = 0;
  std::string steps_;
  // Reports and paths of the programs that orders have replaced.
  std::vector<control::StepReport> reports_before_;
  std::vector<control::PlannedPath> paths_before_;
};

}  // namespace navvy::session
