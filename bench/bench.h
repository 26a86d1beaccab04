// SPDX-License-Identifier: Apache-2.0
// What the bench programs share beyond src/bench: rows to stdout as CSV, and to the file that
// NAVVY_BENCH_CSV names.
#pragma once

#include "bench/measure.h"
#include "bench/row.h"
#include "device/device.h"

namespace navvy::bench {

/// Prints the row to stdout, the first time under its header. `bandwidth` from `copy_bandwidth`, 0
/// when not measured.
void print(const device::DeviceInfo& device, const Row& row, double bandwidth = 0);

/// The same for work of the host alone.
void print_host(const Row& row);

/// Adds the row to the file that NAVVY_BENCH_CSV names, if it does; the header was written by who
/// named it.
void append_csv(const Row& row);

}  // namespace navvy::bench
