// SPDX-License-Identifier: Apache-2.0
// Soil that a dig dumps into the bed of another machine.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "control/observation.h"
#include "control/outcome.h"
#include "core/archive.h"

namespace navvy::control {

/// Returns true if a bed with soil of mass `load` counts as loaded to the mass `wanted` [kg]: it
/// lacks at most 4 % of it.
inline bool is_loaded(double load, double wanted) { return load >= 0.96 * wanted; }

/// Compares, cycle by cycle, the soil that leaves the bucket with the soil that lands in the bed of
/// a receiving machine. Does nothing without a receiver, or if its load is unknown.
class Landing {
 public:
  /// Names the receiver; empty: none.
  explicit Landing(std::string into) : into_(std::move(into)) {}

  /// Begins a dump: measures the loads of bucket and receiver.
  void start(const Observation& seen);
  /// Ends the dump that was begun last, if it has not ended yet, when its soil has come to rest.
  /// Returns why the step has failed: less than half of a load has landed. Otherwise empty.
  std::string end(const Observation& seen);
  /// Returns the mass that landed in each cycle and their sum [kg]; nothing without a receiver.
  std::vector<Measurement> account() const;

  /// Saves or loads the loads of the running dump and the masses landed so far.
  void visit(Archive& a);

 private:
  std::string into_;            ///< name of the receiver
  bool dumping_ = false;        ///< true between `start` and `end`
  double dumped_ = 0;           ///< load of the bucket at the start of the dump [kg]
  double before_ = 0;           ///< load of the receiver then [kg]
  std::vector<double> landed_;  ///< mass that landed in each cycle [kg]
};

}  // namespace navvy::control
