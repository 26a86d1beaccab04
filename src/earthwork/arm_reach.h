// SPDX-License-Identifier: Apache-2.0
// Where the bucket of a machine can dig, as a table over heights. Private to earthwork.
#pragma once

#include <map>

#include "control/arm_kinematics.h"
#include "control/dig_pose.h"

namespace navvy::earthwork {

/// Distances at which a machine digs, by height. Each height is computed once; the result does not
/// depend on the order of calls. Not thread-safe.
class ArmReach {
 public:
  /// Prepares for `arm`, which must outlive this object.
  explicit ArmReach(const control::ArmKinematics& arm) : arm_(arm) {}

  /// Returns the arm.
  const control::ArmKinematics& arm() const { return arm_; }
  /// Returns the distances at which the tip digs at `height` [m] above the swing ring on level
  /// ground. The height is rounded to 0.1 m.
  const control::TipReach& at(double height) const;
  /// Returns true if the tip digs at `reach` [m] and `height` [m], clear of the undercarriage.
  bool contains(double reach, double height) const;

 private:
  const control::ArmKinematics& arm_;
  // Reach by height in steps of 0.1 m.
  mutable std::map<int, control::TipReach> table_;
};

}  // namespace navvy::earthwork
