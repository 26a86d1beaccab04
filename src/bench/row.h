// SPDX-License-Identifier: Apache-2.0
// One benchmark result, and files of results: CSV for comparison, JSON for programs.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace navvy::bench {

/// Run times of one bench, without its warm-up run.
struct Timing {
  /// Wall time of the fastest run [s].
  double best = 0;
  /// Median wall time [s]; 0 means equal to `best`.
  double median = 0;
  /// Relative spread of the wall times: (slowest - best) / best.
  double spread = 0;
  /// Number of timed runs.
  int runs = 0;
  /// Smallest processor time of a run, summed over all threads of this program [s]; 0 means not
  /// measured.
  double processor = 0;
};

/// Measured peak rates of a device; 0 means not measured.
struct Peak {
  /// Bytes read plus bytes written per second by a plain copy kernel.
  double copy_bandwidth = 0;
  /// Single-precision operations per second; a fused multiply-add counts as two operations.
  double flops = 0;
};

/// Result of one bench: one line of a result file. A numeric member of 0 means that it does not
/// apply; its field is then empty in the output.
struct Row {
  /// Name of the bench; a size follows after a colon if the bench runs in several sizes.
  std::string bench;
  /// Number of particles, or of elements in a bench without particles.
  std::uint64_t particles = 0;
  /// Number of time steps in one run.
  std::uint64_t steps = 0;
  /// Times of the runs.
  Timing timing;
  /// Shortest total time of the device's kernels in one run, by the device's own clock [s].
  double kernels = 0;
  /// Memory traffic per particle and step, counted from the kernels' arguments [bytes].
  double bytes_per_particle = 0;
  /// Arithmetic operations per particle and step, counted from the kernels' source.
  double flops_per_particle = 0;
  /// Simulated time of one run [s], for the real-time factor.
  double simulated = 0;
  /// Hash of the state after the run, to detect changed results.
  std::string hash;
  /// Side length of the square site [m], if the site's size matters.
  double site = 0;
  /// Numbers of active blocks and of the nodes that a tool's shell may touch, means over the steps;
  /// not for rows without particles.
  double active_blocks = 0, contact_nodes = 0;
  /// Names of the device and of its driver, from DeviceInfo.
  std::string device, driver;
  /// Peak rates of the device; the row states its own rates as shares of these.
  Peak peak;
};

/// Returns the column names of a result file, in the order of the fields that `cells` returns.
const std::vector<std::string>& columns();
/// Returns the fields of one row as text; a field that does not apply is empty.
std::vector<std::string> cells(const Row& row);

/// Returns the header line of a CSV file, without a line end.
std::string csv_header();
/// Returns one row as a line of CSV, without a line end; text fields are quoted.
std::string csv_line(const Row& row);
/// Returns a JSON array with one object per row. The keys are the column names; numeric fields are
/// JSON numbers, and empty fields are omitted.
std::string json(const std::vector<Row>& rows);

}  // namespace navvy::bench
