// SPDX-License-Identifier: Apache-2.0
#include "bench.h"

#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <map>
#include <string>

namespace navvy::bench {

namespace {

/// Returns the peaks of a device, measured before the first row of a program.
Peak peak_of(const device::DeviceInfo& info) {
  static std::map<int, Peak> known;
  const auto found = known.find(info.index);
  if (found != known.end()) return found->second;
  device::Device device(std::to_string(info.index));
  return known[info.index] = measure_peak(device);
}

void print_row(const Row& row) {
  static bool header = false;
  if (!header) std::printf("%s\n", csv_header().c_str());
  header = true;
  std::printf("%s\n", csv_line(row).c_str());
  std::fflush(stdout);
  append_csv(row);
}

}  // namespace

Peak host_peak() {
  for (const device::DeviceInfo& info : device::list_devices())
    if (info.kind == device::Kind::kCpu) return peak_of(info);
  return {};
}

void print(const device::DeviceInfo& device, Row row) {
  row.device = device.name;
  row.driver = device.driver;
  row.peak = peak_of(device);
  print_row(row);
}

void print_host(Row row) {
  row.device = "host";
  row.peak = host_peak();
  print_row(row);
}

void append_csv(const Row& row) {
  const char* file = std::getenv("NAVVY_BENCH_CSV");
  if (file != nullptr) std::ofstream(file, std::ios::app) << csv_line(row) << "\n";
}

}  // namespace navvy::bench
