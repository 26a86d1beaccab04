// SPDX-License-Identifier: Apache-2.0
// main() of tests that need a device. With NAVVY_TEST_DEVICE=gpu they use that device or show as
// skipped; without it, a machine without any device fails them.
#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>

#include "device/device.h"

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  const char* wanted = std::getenv("NAVVY_TEST_DEVICE");
  if (wanted != nullptr && !testing::GTEST_FLAG(list_tests)) {
    try {
      const navvy::device::Device device(wanted);
      ::setenv("NAVVY_DEVICE", wanted, 1);
      std::printf("on %s\n", device.info().text().c_str());
    } catch (const navvy::device::DeviceError& error) {
      std::printf("[  SKIPPED ] %s\n", error.what());
      return 0;
    }
  }
  return RUN_ALL_TESTS();
}
