// SPDX-License-Identifier: Apache-2.0
// Detects, during any step, that the machine has tipped over or is buried; both end its program.
#pragma once

#include <string>

#include "control/observation.h"
#include "control/outcome.h"
#include "core/archive.h"

namespace navvy::control {

/// Distance that a machine may settle, roll out or be shaken while it is to stand [m].
inline constexpr double kMostMoved = 0.5;

/// Returns true if the site has no column below the point `p_W`, in W [m].
bool is_off_site(const heightfield::Terrain& site, const Vec3& p_W);

/// Checks once per control step whether the machine has tipped over or is buried.
class Watch {
 public:
  /// Returns kRunning while neither has happened; otherwise returns kTipped or kBuried, and stores
  /// an explanation in `reason`. `dt` [s] is the length of the control step.
  ///
  /// A machine has tipped if it is inclined by more than 45 deg, or if its centre of mass has been
  /// outside its support polygon for more than 0.2 s while the inclination keeps growing. It is
  /// buried if at least half of its wheels have their tops below the ground.
  StepState look(const Observation& seen, double dt, std::string& reason);

  /// Saves or loads the time that the centre of mass has been outside the support polygon.
  void visit(Archive& a) { a("outside", outside_); }

 private:
  // Time for which the centre of mass has been outside the support polygon while the inclination
  // grew [s].
  double outside_ = 0;
};

}  // namespace navvy::control
