// SPDX-License-Identifier: Apache-2.0
// One result of a bench, and files of results: CSV to compare, JSON for programs.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace navvy::bench {

/// Wall times of the runs of one bench after its warm-up.
struct Timing {
  /// [s].
  double best = 0;
  /// [s]; 0: equal to best.
  double median = 0;
  /// (slowest - best) / best.
  double spread = 0;
  /// Number of runs.
  int runs = 0;
  /// Least processor time of a run, over all threads of this program [s].
  double processor = 0;
};

/// Peak rates of a device, measured on it; 0 = not measured.
struct Peak {
  /// Bytes read plus written per second by a plain copy.
  double copy_bandwidth = 0;
  /// Single-precision operations per second; a fused multiply-add counts as two.
  double flops = 0;
};

/// One result. Zero in a column that does not apply prints as an empty field.
struct Row {
  /// Name, with the size after a colon where one name has several.
  std::string bench;
  /// Number of particles or elements.
  std::uint64_t particles = 0;
  /// Steps of one run.
  std::uint64_t steps = 0;
  /// Times of the runs.
  Timing timing;
  /// Least time of the device's kernels alone in a run, by its own clock [s].
  double kernels = 0;
  /// Traffic of one step, counted from the kernel's arguments.
  double bytes_per_particle = 0;
  /// Operations of one step, counted from the kernel's lines.
  double flops_per_particle = 0;
  /// Simulated time [s], for the real-time factor.
  double simulated = 0;
  /// State hash of the result.
  std::string hash;
  /// Edge of the square site [m], where it matters.
  double site = 0;
  /// Texts of DeviceInfo.
  std::string device, driver;
  /// Peak rates of the device, for the shares.
  Peak peak;
};

/// Returns the names of the columns, in the order of `cells`.
const std::vector<std::string>& columns();
/// Returns the row's fields as text, empty where they do not apply.
std::vector<std::string> cells(const Row& row);

/// Returns the first line of a CSV file, without its end.
std::string csv_header();
/// Returns one line without its end; text is quoted.
std::string csv_line(const Row& row);
/// Returns an array with one object per row, keys as the columns, numbers as numbers; empty fields
/// are left out.
std::string json(const std::vector<Row>& rows);

}  // namespace navvy::bench
