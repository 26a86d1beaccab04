// SPDX-License-Identifier: Apache-2.0
// What ends a program whatever its step is at: the machine tips over, or is buried.
#pragma once

#include <string>

#include "control/observation.h"
#include "control/outcome.h"
#include "core/archive.h"

namespace navvy::control {

/// Looks at how the machine stands, once a control step.
class Watch {
 public:
  /// kRunning while all is well; else the state, and in `reason` why.
  ///
  /// A machine tips when it is past 45 deg, or when its centre of mass has been outside its feet
  /// for a while and it goes on turning over. It is buried when the ground is over the tops of half
  /// of its wheels.
  StepState look(const Observation& seen, double dt, std::string& reason);

  void visit(Archive& a) { a("outside", outside_); }

 private:
  double outside_ = 0;  // [s] that the centre of mass has been outside while the tilt grew
};

}  // namespace navvy::control
