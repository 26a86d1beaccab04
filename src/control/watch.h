// SPDX-License-Identifier: Apache-2.0
// Detects conditions that end a program during any step: the machine tips over or is buried.
#pragma once

#include <string>

#include "control/observation.h"
#include "control/outcome.h"
#include "core/archive.h"

namespace navvy::control {

/// Checks the machine's stability once per control step.
class Watch {
 public:
  /// Returns kRunning while the machine stands; otherwise the state, with the cause in `reason`.
  ///
  /// A machine has tipped when it is inclined by more than 45 deg, or when its centre of mass has
  /// been outside its support polygon for a while and it keeps turning over. It is buried when the
  /// ground is above the tops of half of its wheels.
  StepState look(const Observation& seen, double dt, std::string& reason);

  void visit(Archive& a) { a("outside", outside_); }

 private:
  // Time for which the centre of mass has been outside while the tilt grew [s].
  double outside_ = 0;
};

}  // namespace navvy::control
