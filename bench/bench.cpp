// SPDX-License-Identifier: Apache-2.0
#include "bench.h"

#include <cstdio>
#include <cstdlib>
#include <fstream>

namespace navvy::bench {

void print(const device::DeviceInfo& device, const Row& row, double bandwidth) {
  static bool header = false;
  Row full = row;
  full.device = device.name;
  full.driver = device.driver;
  if (bandwidth > 0) full.peak.copy_bandwidth = bandwidth;
  if (!header) std::printf("%s\n", csv_header().c_str());
  header = true;
  std::printf("%s\n", csv_line(full).c_str());
  std::fflush(stdout);
  append_csv(full);
}

void print_host(const Row& row) {
  device::DeviceInfo host;
  host.name = "host";
  print(host, row);
}

void append_csv(const Row& row) {
  const char* file = std::getenv("NAVVY_BENCH_CSV");
  if (file != nullptr) std::ofstream(file, std::ios::app) << csv_line(row) << "\n";
}

}  // namespace navvy::bench
