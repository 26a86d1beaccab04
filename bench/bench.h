// SPDX-License-Identifier: Apache-2.0
// Common output of the bench programs: CSV rows to stdout, and to the file named by
// NAVVY_BENCH_CSV.
#pragma once

#include "bench/measure.h"
#include "bench/row.h"
#include "device/device.h"

namespace navvy::bench {

/// Prints the row to stdout with the device's name and peaks, and the header before the first one.
/// The peaks are measured once, before the first row.
void print(const device::DeviceInfo& device, Row row);

/// Returns the peaks of the host's processor, measured once, as its OpenCL driver reaches them;
/// none without a driver.
Peak host_peak();

/// Prints a row for work of the host only, with the peaks of its processor.
void print_host(Row row);

/// Appends the row to the file named by NAVVY_BENCH_CSV, if any. The creator of the file wrote the
/// header.
void append_csv(const Row& row);

}  // namespace navvy::bench
