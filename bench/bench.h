// SPDX-License-Identifier: Apache-2.0
// Common output of the bench programs: rows to stdout as CSV, and to the file that NAVVY_BENCH_CSV
// names.
#pragma once

#include "bench/measure.h"
#include "bench/row.h"
#include "device/device.h"

namespace navvy::bench {

/// Prints the row to stdout, the first time under its header. `bandwidth` from `copy_bandwidth`, 0
/// when not measured.
void print(const device::DeviceInfo& device, const Row& row, double bandwidth = 0);

/// Prints a row for work of the host alone.
void print_host(const Row& row);

/// Appends the row to the file that NAVVY_BENCH_CSV names, if any; the header was written by its
/// creator.
void append_csv(const Row& row);

}  // namespace navvy::bench
