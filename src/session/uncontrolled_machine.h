// SPDX-License-Identifier: Apache-2.0
// Detects the fall of a machine that no program drives. Private to the session.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "control/outcome.h"
#include "control/watch.h"
#include "core/archive.h"
#include "sim/world.h"

namespace navvy::session {

/// Fills the part of an observation that says how a machine stands: pose and velocity of its base
/// link in W, stability, tyre forces [N], and the fraction of its wheels that are below the ground.
void observe_stance(const sim::World& world, const sim::MachineHandle& machine,
                    const std::vector<sim::WheelHandle>& wheels, control::Observation& seen);

/// Watches one machine while inputs drive it, or nothing does.
///
/// A machine that tips over or is buried is reported once: in the log when it happens, and as a
/// step report for the summary.
class UncontrolledMachine {
 public:
  /// Keeps a reference to `world`, which must outlive this object.
  UncontrolledMachine(const sim::World& world, int machine);

  /// Index of the machine in the scene.
  int index() const { return machine_.index(); }
  /// Checks the machine. Call it in each step in which no program drives the machine. `by_inputs`
  /// is true if inputs drive it, which the report mentions.
  void look(bool by_inputs);
  /// Returns the report of its fall, with state (tipped or buried), time and place; empty while it
  /// stands. Its step number is 0, as no step of a program was at fault.
  const std::optional<control::StepReport>& fall() const { return fall_; }

  /// Visits all state that determines later reports.
  void visit(Archive& a);

 private:
  const sim::World& world_;
  sim::MachineHandle machine_;
  std::vector<sim::WheelHandle> wheels_;
  /// Observation of the last step.
  control::Observation seen_;
  control::Watch watch_;
  /// Report of the fall; empty while the machine stands.
  std::optional<control::StepReport> fall_;
};

}  // namespace navvy::session
