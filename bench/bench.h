// SPDX-License-Identifier: Apache-2.0
// Common output of the bench programs: CSV rows to stdout, and to the file named by
// NAVVY_BENCH_CSV.
#pragma once

#include "bench/measure.h"
#include "bench/row.h"
#include "device/device.h"

namespace navvy::bench {

/// Prints the row to stdout, with the header before the first one. `bandwidth` comes from
/// `copy_bandwidth`, 0 if not measured.
void print(const device::DeviceInfo& device, const Row& row, double bandwidth = 0);

/// Prints a row for work of the host only.
void print_host(const Row& row);

/// Appends the row to the file named by NAVVY_BENCH_CSV, if any. The creator of the file wrote the
/// header.
void append_csv(const Row& row);

}  // namespace navvy::bench
