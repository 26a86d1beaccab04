// SPDX-License-Identifier: Apache-2.0
#include "sim/array_outputs.h"

#include <gtest/gtest.h>

#include "core/error.h"

namespace navvy::sim {
namespace {

ArrayChannel image() {
  ArrayChannel channel;
  channel.name = "cam/image";
  channel.unit = "1";
  channel.frame = "cam";
  channel.type = ElementType::kUint8;
  channel.shape = {2, 3, 3};
  return channel;
}

TEST(ArrayOutputs, AreZerosWithoutASequenceUntilPublished) {
  ArrayOutputs outputs;
  const int i = outputs.add(image());
  EXPECT_EQ(outputs.view(i).sequence(), 0u);
  EXPECT_EQ(outputs.view(i).values<std::uint8_t>().size(), 18u);
  EXPECT_EQ(outputs.view(i).values<std::uint8_t>()[17], 0);
  outputs.publish(i, 0.25, make_pose(1, 2, 3, 0, 0, 0))[17] = std::byte{9};
  const ArrayView view = outputs.view("cam/image");
  EXPECT_EQ(view.sequence(), 1u);
  EXPECT_EQ(view.time(), 0.25);
  EXPECT_EQ(view.X_WF().translation().z(), 3);
  EXPECT_EQ(view.values<std::uint8_t>()[17], 9);
  EXPECT_EQ(view.channel().type_text(), "uint8[2,3,3]");
}

TEST(ArrayOutputs, RefuseEmptyShapesAndNamesInUse) {
  ArrayOutputs outputs;
  ArrayChannel empty = image();
  empty.shape = {4, 0};
  EXPECT_THROW(outputs.add(empty), InputError);
  empty.shape = {};
  EXPECT_THROW(outputs.add(empty), InputError);
  outputs.add(image());
  EXPECT_THROW(outputs.add(image()), InputError);
}

TEST(ArrayOutputs, HashAndSnapshotHoldEverythingAReaderSees) {
  ArrayOutputs outputs, copy;
  const int i = outputs.add(image());
  copy.add(image());
  const auto hash_of = [](const ArrayOutputs& arrays) {
    StateHash hash;
    arrays.hash(hash);
    return hash.hex();
  };
  const std::string empty = hash_of(outputs);
  outputs.publish(i, 0.5, make_pose(0, 0, 0, 0, 0, 1))[3] = std::byte{1};
  EXPECT_NE(hash_of(outputs), empty);
  StateWriter writer;
  writer.begin("arrays", 1);
  outputs.save(writer);
  writer.end();
  StateReader reader(writer.bytes());
  reader.begin("arrays", 1);
  copy.load(reader);
  reader.end();
  EXPECT_EQ(hash_of(copy), hash_of(outputs));
  EXPECT_EQ(copy.view(0).time(), 0.5);
  ArrayOutputs other;
  ArrayChannel larger = image();
  larger.shape = {2, 3, 4};
  other.add(larger);
  StateReader again(writer.bytes());
  again.begin("arrays", 1);
  EXPECT_THROW(other.load(again), InputError);
}

}  // namespace
}  // namespace navvy::sim
