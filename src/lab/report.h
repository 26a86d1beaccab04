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

/// Value of a Quantity's number that is missing (NaN). Test for it with std::isnan.
inline constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

/// One measured result of an experiment, its expected value and its tolerance. All numbers are in
/// `unit`, a unit that suits the reader (mm, deg, %), not necessarily SI. kNone marks a missing
/// number.
struct Quantity {
  /// Name of the quantity; readers look results up by it (Report::find).
  std::string name;
  /// Value that the experiment measured; kNone if it could not be measured.
  double measured = kNone;
  /// Unit of all numbers of this quantity, as text; "" for a dimensionless number.
  std::string unit;
  /// Value that theory or the cited experiment predicts; kNone if there is no prediction.
  double expected = kNone;
  /// Lower and upper limit of the tolerance, both inclusive. kNone means that there is no limit on
  /// that side.
  double low = kNone, high = kNone;
  /// Source of the expected value and the tolerance: a reference of docs/bibliography.md, a heading
  /// of docs/, or a remark in words.
  std::string source;
  /// Description of the setups for which the tolerance is valid; empty if it is valid for all
  /// setups of the rig.
  std::string range = "";
  /// True if the tolerance is valid for the setup that was run.
  bool in_range = true;

  /// Returns true if `low` or `high` is given (not kNone).
  bool has_tolerance() const;
  /// Returns true if there is a tolerance and it is valid for the setup that was run.
  bool judged() const { return has_tolerance() && in_range; }
  /// Returns true if the quantity is judged and its measured value is outside the tolerance or NaN.
  bool outside_tolerance() const;
  /// Restricts the tolerance to some setups: `where` describes them, and `here` says whether the
  /// setup that was run is one of them. If `here` is false, the quantity is not judged.
  void holds_for(const std::string& where, bool here) { range = where, in_range = here; }
};

/// A recorded curve, one value per sample. Most series of a report have the same length, so that
/// one of them (time, travel, depth) gives the abscissa of the others.
struct Series {
  /// Name of the curve, and unit of its values as text ("" for a dimensionless number).
  std::string name, unit;
  /// Sampled values, in the order in which they were recorded.
  std::vector<double> values;
};

/// All results of one experiment. If a rig simulates several beds of soil one after the other,
/// steps, times and energies are sums over the beds.
struct Report {
  /// Results in the order in which they are printed.
  std::vector<Quantity> results;
  /// Recorded curves, for CSV files and plots.
  std::vector<Series> series;
  /// Largest number of particles that existed at once.
  int particles_peak = 0;
  /// Number of time steps, summed over all beds.
  std::uint64_t steps = 0;
  /// Simulated time and wall time of the experiment, summed over all beds [s].
  double simulated_time = 0, wall_time = 0;
  /// Mass that was gained or lost without a cause, in units of kMassQuantum; 0 if the mass ledger
  /// balances.
  std::int64_t ledger_error = 0;
  /// Energy account of the soil, summed over all beds; empty unless Setup::energy is set.
  std::optional<soil::EnergyAccount> energy;
  /// Hash of the soil's final state [hex]. Repeating the experiment on the same device gives the
  /// same hash.
  std::string state_hash;

  /// Appends a result with an expected value and a tolerance `low` .. `high`, all in `unit` (kNone:
  /// not given). Returns a reference to the new result, valid until the next result is appended.
  Quantity& add(const std::string& name, double measured, const std::string& unit, double expected,
                double low, double high, const std::string& source);
  /// Appends a result in `unit` that has neither an expected value nor a tolerance.
  void note(const std::string& name, double measured, const std::string& unit,
            const std::string& source = "");
  /// Returns the first result of this name, or null if there is none. The pointer is valid until
  /// the next result is appended.
  const Quantity* find(const std::string& name) const;
  /// Returns true if at least one result is judged and outside its tolerance.
  bool outside_tolerance() const;
};

}  // namespace navvy::lab
