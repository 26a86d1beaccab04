// SPDX-License-Identifier: Apache-2.0
// Detects that a machine which no program controls has fallen. Private to the session.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "control/outcome.h"
#include "control/watch.h"
#include "core/archive.h"
#include "sim/world.h"

namespace navvy::session {

/// Fills in the part of an observation that describes the state of the base: pose and velocity of
/// the base link in W, stability, force on the tyres [N], and the fraction of the wheels that are
/// below the ground.
void observe_stance(const sim::World& world, const sim::MachineHandle& machine,
                    const std::vector<sim::WheelHandle>& wheels, control::Observation& seen);

/// Returns true if a closed hitch couples the machine with the index `machine` in the scene.
bool is_coupled(const sim::World& world, int machine);

/// Monitors one machine while no program controls it.
///
/// If the machine falls, that is, tips over or is buried, leaves the site, or is pushed away while
/// nothing drives it, this is reported: in the log at that moment, and as a step report for the
/// summary. A machine that was pushed away may still fall, which is a second report.
class UncontrolledMachine {
 public:
  /// Makes the monitor of the machine with the index `machine` in the scene. `world` must outlive
  /// this object.
  UncontrolledMachine(const sim::World& world, int machine);

  /// Returns the index of the machine in the scene.
  int index() const { return machine_.index(); }
  /// Checks the machine. Call it in each step in which no program controls the machine. `by_inputs`
  /// is true if inputs have taken it over from its program; the report states that.
  void look(bool by_inputs);
  /// Records that inputs drive the machine from now on, so that it may move.
  void take() { driven_ = true; }
  /// Records that a program controls the machine from now on. A report that it was pushed away or
  /// left the site is over then.
  void hand_over();
  /// Returns the last report of the machine, with state (kTipped, kBuried, kOffSite or kMoved),
  /// time and position; empty if there is nothing to report. Its step number is 0, because it
  /// belongs to no step of a program.
  const std::optional<control::StepReport>& fall() const { return fall_; }

  /// Saves or loads all state that affects later reports.
  void visit(Archive& a);

 private:
  /// Returns kOffSite or kMoved with a reason, or kRunning.
  control::StepState look_at_place(std::string& reason);

  // World that the machine is in.
  const sim::World& world_;
  // The monitored machine.
  sim::MachineHandle machine_;
  // All wheels of the machine, in the order of its description.
  std::vector<sim::WheelHandle> wheels_;
  // Observation of the machine in the last step.
  control::Observation seen_;
  // Detects that the machine has fallen.
  control::Watch watch_;
  // Last report; empty if there is none.
  std::optional<control::StepReport> fall_;
  // Place that the machine is to keep, in W [m].
  Vec3 stood_;
  // True if inputs have driven the machine.
  bool driven_ = false;
  // True if the base has been on the site.
  bool on_site_ = false;
};

}  // namespace navvy::session
