// SPDX-License-Identifier: Apache-2.0
// One result of a bench, and the files that hold many: CSV to compare, JSON to read by program.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace navvy::bench {

/// Wall times of the runs of one bench after its warm-up.
struct Timing {
  double best = 0;    ///< [s]
  double median = 0;  ///< [s]; 0 = as best
  double spread = 0;  ///< (slowest - best) / best
  int runs = 0;
  double processor = 0;  ///< least time of a run that all threads of this program took together [s]
};

/// What a device can do at most, measured on it; 0 = not measured.
struct Peak {
  double copy_bandwidth = 0;  ///< bytes read plus written per second by a plain copy
  /// Single-precision operations per second, a fused multiply-add counts as two.
  double flops = 0;
};

/// One result. Zero in a column that does not apply prints as an empty field.
struct Row {
  std::string bench;            ///< name, after a colon the size where one name has several
  std::uint64_t particles = 0;  ///< or elements
  std::uint64_t steps = 0;
  Timing timing;
  /// Least time the device's kernels alone took in a run, by its own clock [s].
  double kernels = 0;
  double bytes_per_particle = 0;  ///< traffic of one step, counted from the kernel's arguments
  double flops_per_particle = 0;  ///< of one step, counted from the kernel's lines
  double simulated = 0;           ///< simulated time [s], for the real-time factor
  std::string hash;               ///< of the result
  double site = 0;                ///< edge of the square site [m], where it matters
  std::string device, driver;     ///< as DeviceInfo says
  Peak peak;                      ///< of the device, for the shares
};

/// Names of the columns, in the order of `cells`.
const std::vector<std::string>& columns();
/// The row's fields as text, empty where they do not apply.
std::vector<std::string> cells(const Row& row);

/// The first line of a CSV file, without its end.
std::string csv_header();
/// One line without its end; text is quoted.
std::string csv_line(const Row& row);
/// An array with one object a row, keys as the columns, numbers as numbers; empty fields are left
/// out.
std::string json(const std::vector<Row>& rows);

}  // namespace navvy::bench
