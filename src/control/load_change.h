// SPDX-License-Identifier: Apache-2.0
// Mass that leaves a bucket or a bed during a program step.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "control/outcome.h"
#include "core/archive.h"

namespace navvy::control {

/// Function that returns a mass of soil [kg]; empty if it is unknown.
using Load = std::function<double()>;

/// Mass of the soil in a bucket or bed at the start of a step that empties it.
class LoadChange {
 public:
  /// Measures the load at the start of the step.
  void start(const Load& load) { start_ = load ? load() : kUnknown; }
  /// Returns why the step has failed: `container` ("bed") was empty at its start, or less than 1 %
  /// of the load has left it. Empty if it has not failed, or if the load is unknown.
  std::string shortfall(const Load& load, const std::string& container) const;
  /// Returns the load at the start, and the mass that has left since, under the name `left` [kg];
  /// nothing if the load is unknown.
  std::vector<Measurement> account(const Load& load, const char* left) const;

  /// Saves or loads the load at the start.
  void visit(Archive& a) { a("load_at_start", start_); }

 private:
  static constexpr double kUnknown = -1;
  double start_ = kUnknown;  ///< load at the start [kg]; kUnknown if there is no gauge
};

}  // namespace navvy::control
