// SPDX-License-Identifier: Apache-2.0
// A machine that no program drives: somebody must see when it falls over. Private to the session.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "control/outcome.h"
#include "control/watch.h"
#include "core/archive.h"
#include "sim/world.h"

namespace navvy::session {

/// How the machine stands and where, as watches and operators see it: pose, stability, wheels under
/// the ground.
void see_standing(const sim::World& world, const sim::MachineHandle& machine,
                  const std::vector<sim::WheelHandle>& wheels, control::Observation& seen);

/// Watches one machine while inputs drive it or nobody does. Its fall is told once, as what a step
/// came to.
class UncontrolledMachine {
 public:
  /// `world` must outlive it.
  UncontrolledMachine(const sim::World& world, int machine);

  int index() const { return machine_.index(); }
  /// To be called in each step in which no program drives the machine; `by_inputs`: what its report
  /// says of that.
  void look(bool by_inputs);
  /// Of its fall: tipped or buried, with time and place; step 0, as no program's step was at fault.
  const std::optional<control::StepReport>& fall() const { return fall_; }

  void visit(Archive& a);

 private:
  const sim::World& world_;
  sim::MachineHandle machine_;
  std::vector<sim::WheelHandle> wheels_;
  control::Observation seen_;
  control::Watch watch_;
  std::optional<control::StepReport> fall_;
};

}  // namespace navvy::session
