// SPDX-License-Identifier: Apache-2.0
#include "sim/array_outputs.h"

#include <gtest/gtest.h>

#include "core/error.h"
#include "core/saved_state.h"
#include "flip_bytes.h"

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
  outputs.publish(i, 0.25, make_pose(1, 2, 3, 0, 0, 0), 0.25)[17] = std::byte{9};
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

TEST(ArrayOutputs, HashAndSaveEverythingVisibleToReaders) {
  ArrayOutputs outputs, copy;
  const int i = outputs.add(image());
  copy.add(image());
  const std::uint64_t empty = hash_of(outputs).digest();
  outputs.publish(i, 0.5, make_pose(0, 0, 0, 0, 0, 1), 0.5)[3] = std::byte{1};
  EXPECT_NE(hash_of(outputs).digest(), empty);
  const std::byte* storage = copy.view(0).bytes().data();
  load_saved(saved(outputs), copy);
  EXPECT_EQ(hash_of(copy).digest(), hash_of(outputs).digest());
  EXPECT_EQ(copy.view(0).time(), 0.5);
  EXPECT_EQ(copy.view(0).bytes().data(), storage) << "an array never changes its address";
  EXPECT_EQ(test::flip_every_byte(outputs, copy), "");
}

TEST(ArrayOutputs, LoadOnlyMatchingArrays) {
  ArrayOutputs outputs, larger, renamed, none;
  outputs.add(image());
  ArrayChannel channel = image();
  channel.shape = {2, 3, 4};
  larger.add(channel);
  channel = image();
  channel.name = "cam/depth";
  renamed.add(channel);
  for (ArrayOutputs* other : {&larger, &renamed, &none})
    EXPECT_THROW(load_saved(saved(outputs), *other), InputError);
}

}  // namespace
}  // namespace navvy::sim
