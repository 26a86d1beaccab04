// SPDX-License-Identifier: Apache-2.0
// What an experiment of the laboratory gives: numbers held against theory, curves, and what the run
// was.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "soil/energy.h"

namespace navvy::lab {

/// "there is none" in a Quantity.
inline constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

/// One result. `expected` is what theory or the cited experiment says, `low` .. `high` the gate;
/// kNone where there is none. Units are those a reader wants (mm, deg, %), spelled out in `unit`.
struct Quantity {
  std::string name;
  double measured = kNone;
  std::string unit;  ///< "" for a pure number
  double expected = kNone;
  double low = kNone, high = kNone;  ///< either may be kNone: an open side
  /// Of expected and gate: a reference as in docs/bibliography.md, a heading of docs/, words.
  std::string source;
  /// What the gate holds for, in words; empty where it holds for every setup of the rig.
  std::string range = "";
  bool in_range = true;  ///< whether this setup lies there

  bool has_tolerance() const;
  /// Whether the gate says anything about this setup.
  bool judged() const { return has_tolerance() && in_range; }
  /// Judged, and outside the gate or not a number.
  bool missed() const;
  /// Limits the gate to what its source speaks of. Of a setup outside it nothing can be missed.
  void holds_for(const std::string& where, bool here) { range = where, in_range = here; }
};

/// A recorded curve; series of one report have one length unless their names say otherwise.
struct Series {
  std::string name, unit;
  std::vector<double> values;
};

/// Everything one experiment gives. A rig that runs several beds one after the other sums their
/// steps and times.
struct Report {
  std::vector<Quantity> results;  ///< in the order in which a reader wants them
  std::vector<Series> series;
  int particles_peak = 0;
  std::uint64_t steps = 0;
  double simulated_time = 0, wall_time = 0;   ///< [s]
  std::int64_t ledger_error = 0;              ///< [kMassQuantum]; 0 = mass closed
  std::optional<soil::EnergyAccount> energy;  ///< of all beds, when the setup asks for it
  std::string state_hash;                     ///< of the soil at the end, repeatable on one device

  /// Adds a result with a gate around the expected value. What it returns is good until the next is
  /// added.
  Quantity& add(const std::string& name, double measured, const std::string& unit, double expected,
                double low, double high, const std::string& source);
  /// Adds a result without gate.
  void note(const std::string& name, double measured, const std::string& unit,
            const std::string& source = "");
  const Quantity* find(const std::string& name) const;  ///< null when there is none
  bool missed() const;                                  ///< any of the results
};

}  // namespace navvy::lab
