// SPDX-License-Identifier: Apache-2.0
// Results of a laboratory experiment: values compared with theory, curves, and properties of the
// run.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "soil/energy.h"

namespace navvy::lab {

/// Marks a missing value in a Quantity.
inline constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

/// One result. `expected` comes from theory or the cited experiment, `low` .. `high` is the
/// tolerance; kNone where there is none. Units are those that a reader wants (mm, deg, %), spelled
/// out in `unit`.
struct Quantity {
  /// Name of the quantity.
  std::string name;
  /// Measured value.
  double measured = kNone;
  /// "" for a pure number.
  std::string unit;
  double expected = kNone;
  /// Either may be kNone: an open end.
  double low = kNone, high = kNone;
  /// Source of expectation and tolerance: a reference as in docs/bibliography.md, a heading of
  /// docs/, or words.
  std::string source;
  /// Validity of the tolerance in words; empty if it holds for every setup of the rig.
  std::string range = "";
  /// This setup is within the validity.
  bool in_range = true;

  /// Returns true if `low` or `high` is given.
  bool has_tolerance() const;
  /// Returns true if the tolerance applies to this setup.
  bool judged() const { return has_tolerance() && in_range; }
  /// Returns true if it applies and the value lies outside or is not a number.
  bool missed() const;
  /// Restricts the tolerance to the validity of its source. A setup outside cannot miss it.
  void holds_for(const std::string& where, bool here) { range = where, in_range = here; }
};

/// A recorded curve. Series of one report have one length unless their names say otherwise.
struct Series {
  std::string name, unit;
  /// Samples, in order.
  std::vector<double> values;
};

/// All results of one experiment. A rig that runs several beds in sequence sums their steps and
/// times.
struct Report {
  /// Results in the order in which a reader wants them.
  std::vector<Quantity> results;
  std::vector<Series> series;
  /// Largest number of particles.
  int particles_peak = 0;
  /// Steps of all beds.
  std::uint64_t steps = 0;
  /// [s].
  double simulated_time = 0, wall_time = 0;
  /// [kMassQuantum]; 0 = mass closed.
  std::int64_t ledger_error = 0;
  /// Energy account of all beds, if the setup asks for it.
  std::optional<soil::EnergyAccount> energy;
  /// Hash of the soil at the end, repeatable on one device.
  std::string state_hash;

  /// Adds a result with a tolerance around the expected value. The reference is valid until the
  /// next call.
  Quantity& add(const std::string& name, double measured, const std::string& unit, double expected,
                double low, double high, const std::string& source);
  /// Adds a result without a tolerance.
  void note(const std::string& name, double measured, const std::string& unit,
            const std::string& source = "");
  /// Returns null when there is none.
  const Quantity* find(const std::string& name) const;
  /// Returns true if any result missed its tolerance.
  bool missed() const;
};

}  // namespace navvy::lab
