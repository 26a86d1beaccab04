// SPDX-License-Identifier: Apache-2.0
#include "device/traffic.h"

#include <gtest/gtest.h>

#include <vector>

#include "device/kernel_program.h"

namespace navvy::device {
namespace {

TEST(DeviceTraffic, CountsLaunchesAndBytes) {
  Device device;
  const KernelProgram program = KernelProgram::from_text(
      device, "set.cl", "kernel void set(global int* x) { x[get_global_id(0)] = 1; }\n");
  Kernel set(program, "set");
  const DeviceTraffic start = traffic();
  Buffer<int> values(device, std::vector<int>(100, 7));
  EXPECT_EQ(traffic().written_bytes - start.written_bytes, 400u);
  set.args(values).enqueue(100);
  set.enqueue(50);
  EXPECT_EQ(traffic().launches - start.launches, 2u);
  EXPECT_EQ(traffic().waits, start.waits);
  EXPECT_EQ(values.read(), std::vector<int>(100, 1));
  EXPECT_EQ(traffic().waits - start.waits, 1u);
  { const auto view = values.map_read_later(10, 20); }
  EXPECT_EQ(traffic().waits - start.waits, 1u);
  { const auto view = values.map_update(10, 20); }
  const DeviceTraffic end = traffic();
  EXPECT_EQ(end.waits - start.waits, 2u);
  EXPECT_EQ(end.read_bytes - start.read_bytes, 400u + 80u + 80u);
  // What is mapped to be changed goes back as a whole.
  EXPECT_EQ(end.written_bytes - start.written_bytes, 400u + 80u);
  // Fills stay on the device.
  values.fill(3);
  EXPECT_EQ(traffic().written_bytes, end.written_bytes);
}

}  // namespace
}  // namespace navvy::device
