// SPDX-License-Identifier: Apache-2.0
#include "record/array_file.h"

#include <gtest/gtest.h>

#include <cstring>

#include "folder.h"
#include "text_of.h"

namespace navvy::record {
namespace {

using test::text_of;

/// An array of three uint16 numbers.
class ArrayFileTest : public testing::Test {
 protected:
  ArrayFileTest() {
    sim::ArrayChannel channel;
    channel.name = "three";
    channel.type = sim::ElementType::kUint16;
    channel.shape = {3};
    outputs_.add(channel);
  }
  void publish(std::uint16_t value) {
    const std::uint16_t numbers[3] = {value, value, value};
    std::memcpy(outputs_.publish(0, 0.5 * value, Pose::Identity(), 0.5 * value).data(), numbers,
                sizeof numbers);
  }
  static constexpr std::size_t kRecord = 72 + 6;

  sim::ArrayOutputs outputs_;
  const test::Folder folder_;
};

TEST_F(ArrayFileTest, KeepsItsHeaderLengthWhileItGrows) {
  const std::string path = folder_ / "a.npy";
  ArrayFile file(path, outputs_.channels()[0]);
  EXPECT_FALSE(std::filesystem::exists(path));
  file.flush();
  const std::size_t header = text_of(path).size();
  EXPECT_EQ(header % 64, 0u);
  for (std::uint16_t i = 1; i <= 1000; ++i) {
    publish(i);
    file.add(outputs_.view(0));
    if (i % 300 == 0) file.flush();
  }
  file.sync();
  EXPECT_EQ(file.records(), 1000u);
  const std::string text = text_of(path);
  ASSERT_EQ(text.size(), header + 1000 * kRecord);
  EXPECT_NE(text.find("1000,), }"), std::string::npos);
  EXPECT_EQ(static_cast<unsigned char>(text.back()), 1000 >> 8);
}

TEST_F(ArrayFileTest, WritesWhenAMebibyteIsPending) {
  const std::string path = folder_ / "a.npy";
  ArrayFile file(path, outputs_.channels()[0]);
  publish(1);
  const std::size_t enough = RecordFile::kMaxWaiting / kRecord + 1;
  for (std::size_t i = 0; i < enough; ++i) file.add(outputs_.view(0));
  EXPECT_GE(text_of(path).size(), RecordFile::kMaxWaiting);
}

}  // namespace
}  // namespace navvy::record
