// SPDX-License-Identifier: Apache-2.0
#include "vehicle/encoder.h"

#include <algorithm>
#include <cmath>

namespace navvy::vehicle {
namespace {

// Beyond 2^53 a double cannot represent every count. A wheel of 10^7 counts per turn gets there in
// 28 years at one turn per second.
constexpr double kMostCounts = 0x1.0p53;
// Largest number of counts per step that are drawn one by one; a real wheel makes some hundred. A
// longer jump loses its share without random numbers.
constexpr std::int64_t kMostDice = 100000;

}  // namespace

JointEncoder::JointEncoder(const scene::Encoder& about, double position, std::uint64_t seed)
    : about_(about), position_(position), dice_(seed) {
  set_slip(about.slip);
  set_missed(about.missed);
}

void JointEncoder::set_slip(double slip) { slip_ = std::clamp(slip, -kMostSlip, kMostSlip); }
void JointEncoder::set_missed(double share) { missed_ = std::clamp(share, 0.0, 1.0); }

// Counts whole edges since the last call and loses some of them at random.
void JointEncoder::advance(double position) {
  // A slipping wheel turns by 1 / (1 - s) times the distance that it rolls.
  turned_ += (position - position_) / (2 * kPi) * about_.counts_per_turn / (1 - slip_);
  turned_ = std::clamp(turned_, -kMostCounts, kMostCounts);
  position_ = position;
  const auto edges = static_cast<std::int64_t>(std::floor(turned_));
  const std::int64_t passed = edges - edges_;
  edges_ = edges;
  const auto noticed = static_cast<std::uint64_t>(std::abs(passed) - lost_of(std::abs(passed)));
  counter_ += passed < 0 ? 0 - noticed : noticed;
}

std::int64_t JointEncoder::lost_of(std::int64_t edges) {
  if (missed_ <= 0) return 0;
  if (edges > kMostDice) return std::llround(missed_ * static_cast<double>(edges));
  std::int64_t lost = 0;
  for (std::int64_t i = 0; i < edges; ++i) lost += dice_.uniform() < missed_ ? 1 : 0;
  return lost;
}

std::uint64_t JointEncoder::counts() const {
  // The low bits of a count below 0, modulo 2^64, are those of a register that wrapped downwards.
  return counter_ & ((std::uint64_t{1} << about_.bits) - 1);
}

// Visits everything that decides the counts to come.
void JointEncoder::visit(Archive& a) {
  // The bounds keep all derived counts within 64 bits.
  constexpr auto kMost = static_cast<std::int64_t>(kMostCounts);
  a("position", position_);
  a.require(std::isfinite(position_), "position",
            "the position of an encoder's joint must be finite");
  a.ranged("turned", turned_, -kMostCounts, kMostCounts);
  a.ranged("edges", edges_, -kMost, kMost);
  a("counter", counter_);
  a.ranged("slip", slip_, -kMostSlip, kMostSlip);
  a.ranged("missed", missed_, 0.0, 1.0);
  a("dice", dice_);
}

// Draws one seed per encoder from the machine's.
Encoders::Encoders(const scene::Machine& machine, const PhysicsEngine& engine, int index,
                   std::uint64_t seed) {
  Random seeds(seed);
  for (const scene::Encoder& about : machine.encoders) {
    const int joint = machine.joint_index(about.joint);
    // The loader refuses such an encoder; in a scene built in code it never counts.
    joints_.push_back(joint);
    encoders_.emplace_back(about, joint < 0 ? 0.0 : engine.joint(index, joint).position,
                           seeds.next());
  }
}

void Encoders::advance(const PhysicsEngine& engine, int index) {
  for (std::size_t e = 0; e < encoders_.size(); ++e)
    if (joints_[e] >= 0) encoders_[e].advance(engine.joint(index, joints_[e]).position);
}

int Encoders::place_of(int joint) const {
  const auto found = std::find(joints_.begin(), joints_.end(), joint);
  return joint < 0 || found == joints_.end() ? -1 : static_cast<int>(found - joints_.begin());
}

void Encoders::visit(Archive& a) { a.fixed("encoders", encoders_); }

}  // namespace navvy::vehicle
