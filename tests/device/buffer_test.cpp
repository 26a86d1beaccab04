// SPDX-License-Identifier: Apache-2.0
#include "device/buffer.h"

#include <gtest/gtest.h>

#include <numeric>
#include <string>
#include <vector>

namespace navvy::device {
namespace {

struct Triple {
  int a, b, c;
};

TEST(Buffer, ReadsBackWhatWasWrittenAtAnyOffset) {
  Device device;
  Buffer<float> buffer(device, 7);
  buffer.fill(1.5f);
  buffer.write(std::vector<float>{8, 9}, 5);
  EXPECT_EQ(buffer.read(), (std::vector<float>{1.5f, 1.5f, 1.5f, 1.5f, 1.5f, 8, 9}));
  std::vector<float> tail(3);
  buffer.read(tail, 4);
  EXPECT_EQ(tail, (std::vector<float>{1.5f, 8, 9}));
}

TEST(Buffer, MayBeEmpty) {
  Device device;
  Buffer<float> buffer(device, 0);
  EXPECT_TRUE(buffer.empty());
  EXPECT_TRUE(buffer.read().empty());
  buffer.fill(3);
  EXPECT_EQ(buffer.map_read().size(), 0u);
  EXPECT_EQ(buffer.map_update().size(), 0u);
  buffer.resize(2);
  buffer.fill(3);
  EXPECT_EQ(buffer.read(), (std::vector<float>{3, 3}));
}

TEST(Buffer, FillsWithStructsOfAnySize) {
  Device device;
  Buffer<Triple> buffer(device, 5);
  buffer.fill(Triple{1, 2, 3});
  buffer.fill(Triple{7, 8, 9}, 3, 1);
  const std::vector<Triple> values = buffer.read();
  EXPECT_EQ(values[2].c, 3);
  EXPECT_EQ(values[3].b, 8);
  EXPECT_EQ(values[4].a, 1);
}

TEST(Buffer, KeepsItsValuesWhenItGrowsAndShrinks) {
  Device device;
  std::vector<int> values(1000);
  std::iota(values.begin(), values.end(), 0);
  Buffer<int> buffer(device, values);
  buffer.resize(5000);
  buffer.resize(1000);
  EXPECT_EQ(buffer.read(), values);
  buffer.resize(3);
  EXPECT_EQ(buffer.read(), (std::vector<int>{0, 1, 2}));
}

TEST(Buffer, MapsToReadAndUpdate) {
  Device device;
  Buffer<int> buffer(device, 4);
  {
    auto view = buffer.map_update();
    std::iota(view.begin(), view.end(), 10);
  }
  {
    auto view = buffer.map_update(1, 2);
    ASSERT_EQ(view.size(), 2u);
    view[1] *= 2;
  }
  const auto view = buffer.map_read();
  EXPECT_EQ(std::vector<int>(view.begin(), view.end()), (std::vector<int>{10, 11, 24, 13}));
}

TEST(Buffer, MapsWithoutACopyWhereMemoryIsShared) {
  Device device;
  if (!device.info().shares_memory) GTEST_SKIP() << device.info().name << " has separate memory";
  Buffer<int> buffer(device, 1 << 20);
  const int* first = buffer.map_read().data();
  const int* again = buffer.map_update().data();
  // A staging copy would have a new allocation each time.
  EXPECT_EQ(first, again);
  EXPECT_EQ(buffer.map_read(100, 1).data(), first + 100);
}

TEST(Buffer, RefusesARangeOutsideItself) {
  Device device;
  Buffer<int> buffer(device, 4);
  EXPECT_THROW(buffer.write(std::vector<int>{1, 2}, 3), DeviceError);
  EXPECT_THROW(buffer.map_read(5), DeviceError);
  EXPECT_THROW(buffer.fill(0, 2, 3), DeviceError);
}

TEST(Buffer, ReportsTheSizeOfAFailedAllocation) {
  Device device;
  try {
    Buffer<char> buffer(device, std::size_t{1} << 50);
    FAIL() << "a petabyte was allocated";
  } catch (const DeviceError& error) {
    EXPECT_NE(std::string(error.what()).find("1125899906842624 bytes failed: CL_"),
              std::string::npos)
        << error.what();
    EXPECT_NE(std::string(error.what()).find(device.info().name), std::string::npos);
  }
}

}  // namespace
}  // namespace navvy::device
