// SPDX-License-Identifier: Apache-2.0
// Soil that a scoop brings beyond the mass that a bed lacks.
#pragma once

#include "core/archive.h"

namespace navvy::control {

/// Lets the surplus of a scoop fall back to where it came from: opens the lifted bucket slowly
/// until its load is no more than wanted, and closes it again.
class Trim {
 public:
  /// Begins with a new scoop, nothing of which has been dropped yet.
  void start() { *this = {}; }
  /// Advances by `dt` [s] with the load `payload` in the bucket, of which at most `most` is wanted
  /// [kg]. Returns true while the bucket is not closed.
  bool advance(double payload, double most, double dt);
  /// Returns the angle by which the bucket is opened [rad].
  double opening() const { return opening_; }

  /// Saves or loads all fields.
  void visit(Archive& a);

 private:
  double opening_ = 0;    ///< [rad]
  bool closing_ = false;  ///< true once enough has fallen, or will while the bucket closes
  double before_ = 0;     ///< load at the step before [kg]
  double loss_ = 0;       ///< rate at which soil falls [kg/s]
};

}  // namespace navvy::control
