// SPDX-License-Identifier: Apache-2.0
#include "vehicle/encoder.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/error.h"
#include "core/saved_state.h"
#include "flip_bytes.h"
#include "vehicle/machines.h"

namespace navvy::vehicle {
namespace {

constexpr double kTurn = 2 * kPi;

scene::Encoder encoder(double counts, int bits) {
  scene::Encoder about;
  about.joint = "spin";
  about.counts_per_turn = counts;
  about.bits = bits;
  return about;
}

TEST(JointEncoder, OfSixteenBitsAnd128CountsAMillimetreWrapsAfter512Millimetres) {
  // A wheel of 97.5 mm radius: 128 counts on each millimetre of its rim.
  const double radius = 0.0975;
  JointEncoder counter(encoder(128e3 * kTurn * radius, 16), 0, 1);
  const auto roll_to = [&](double length) { counter.advance(length / radius); };
  roll_to(0.5119);
  EXPECT_EQ(counter.counts(), 65523u);  // 65523.2 counts
  roll_to(0.5121);
  EXPECT_EQ(counter.counts(), 12u);
  // And back: downwards past 0.
  roll_to(-0.0001);
  EXPECT_EQ(counter.counts(), 65536u - 13u);  // -12.8 counts, floor
}

TEST(JointEncoder, CountsFromTheInitialPositionAndKeepsFractions) {
  JointEncoder counter(encoder(100, 8), 3.0, 1);
  EXPECT_EQ(counter.counts(), 0u);
  // Steps of 0.3 counts: none is lost between two readings.
  for (int i = 1; i <= 1000; ++i) counter.advance(3.0 + i * 0.3 / 100 * kTurn + 1e-9);
  EXPECT_EQ(counter.counts(), 300u % 256u);
}

TEST(JointEncoder, RegistersOfAnyWidthWrap) {
  for (const int bits : {2, 12, 16, 24, 32}) {
    JointEncoder counter(encoder(1, bits), 0, 1);
    const double range = std::exp2(bits);
    // Half a count on, away from edges within rounding.
    counter.advance((range + 1.5) * kTurn);
    EXPECT_EQ(counter.counts(), 1u) << bits;
    counter.advance(-0.5 * kTurn);
    EXPECT_EQ(counter.counts(), (std::uint64_t{1} << bits) - 1) << bits;
  }
}

TEST(JointEncoder, LosesTheConfiguredShareInEitherDirection) {
  scene::Encoder about = encoder(1000, 32);
  about.missed = 0.02;
  JointEncoder counter(about, 0, 5);
  for (int i = 1; i <= 100; ++i) counter.advance(i * kTurn + 1e-6);
  const auto there = static_cast<double>(counter.counts());
  // 100 000 counts, 2000 missed with a standard deviation of 44: six of them.
  EXPECT_NEAR(there, 98000, 270);
  for (int i = 99; i >= 0; --i) counter.advance(i * kTurn + 1e-6);
  // On the return it misses others: a real one does not return exactly.
  const auto home = static_cast<std::int32_t>(static_cast<std::uint32_t>(counter.counts()));
  EXPECT_NE(home, 0);
  EXPECT_LT(std::abs(home), 400);
  // All of them, and a jump larger than a wheel's step.
  counter.set_missed(1);
  const std::uint64_t before = counter.counts();
  counter.advance(50 * kTurn);
  EXPECT_EQ(counter.counts(), before);
  counter.set_missed(0.5);
  counter.advance(50 * kTurn + 1000 * kTurn);
  EXPECT_NEAR(static_cast<double>(counter.counts() - before), 500e3, 1);
}

TEST(JointEncoder, AcceptsFaultsWithinTheirBounds) {
  JointEncoder counter(encoder(100, 16), 0, 1);
  counter.set_slip(7);
  counter.set_missed(-3);
  EXPECT_EQ(counter.slip(), JointEncoder::kMostSlip);
  EXPECT_EQ(counter.missed(), 0);
}

TEST(Encoders, HashEveryByteTheySaveAndRefuseOthers) {
  scene::Machine machine = testing::robot();
  machine.encoders = {encoder(100, 16), encoder(100, 16)};
  machine.encoders[0].joint = machine.wheels[0].joint;
  machine.encoders[1].joint = machine.wheels[1].joint;
  machine.encoders[1].missed = 0.5;
  auto engine = make_kinematic_engine();
  engine->add_machine(machine, Pose::Identity());
  Encoders encoders(machine, *engine, 0, 3), target(machine, *engine, 0, 3);
  engine->set_drive(0, {0.7, 0.2, false});
  testing::run(*engine, testing::flat(), 1, 0.01, [&](double) { encoders.advance(*engine, 0); });
  EXPECT_EQ(test::flip_every_byte(encoders, target), "");
  machine.encoders.pop_back();
  Encoders fewer(machine, *engine, 0, 3);
  EXPECT_THROW(load_saved(saved(encoders), fewer), InputError);
}

}  // namespace
}  // namespace navvy::vehicle
