// SPDX-License-Identifier: Apache-2.0
// Encoders of a machine's joints: counters of a few bits, as a real robot hands them to its
// controller. Know no kind of engine, so that a controller cannot tell by them which one moves the
// machine.
#pragma once

#include <cstdint>
#include <vector>

#include "core/archive.h"
#include "core/random.h"
#include "scene/machine.h"
#include "vehicle/physics_engine.h"

namespace navvy::vehicle {

/// One incremental encoder [docs/machines.md, encoders]. It starts at 0 where its joint stands,
/// counts up as the joint turns positively, down as it turns back, and wraps at 2^bits.
class JointEncoder {
 public:
  /// Injected faults keep within these bounds.
  static constexpr double kMostSlip = 0.9;

  /// `seed` decides which counts are missed.
  JointEncoder(const scene::Encoder& about, double position, std::uint64_t seed);

  /// The joint has turned to `position` [rad]; how it got there since the last call does not
  /// matter.
  void advance(double position);
  /// As its register holds it, 0 to 2^bits - 1.
  std::uint64_t counts() const;
  const scene::Encoder& about() const { return about_; }

  /// Faults from now on; what has been counted stays.
  /// Slip s that the counts pretend: they say w r where w r (1 - s) was rolled. Cut to +-kMostSlip.
  void set_slip(double slip);
  double slip() const { return slip_; }
  /// Share of the counts that are lost, in either direction, each by chance. Cut to 0 .. 1.
  void set_missed(double share);
  double missed() const { return missed_; }

  /// Register, faults and the chance to come.
  void visit(Archive& a);

 private:
  std::int64_t lost_of(std::int64_t edges);

  scene::Encoder about_;
  double position_ = 0;     // [rad] at the last call
  double turned_ = 0;       // [counts] since the start, fractions included
  std::int64_t edges_ = 0;  // whole ones of them
  // Of those the encoder noticed, modulo 2^64; its low bits are the register
  std::uint64_t counter_ = 0;
  double slip_ = 0, missed_ = 0;
  Random dice_;
};

/// All encoders of one machine, in the order of its file.
class Encoders {
 public:
  /// The machine is number `index` of the engine; `seed` is this machine's alone.
  Encoders(const scene::Machine& machine, const PhysicsEngine& engine, int index,
           std::uint64_t seed);

  /// After every step of the engine.
  void advance(const PhysicsEngine& engine, int index);
  std::size_t size() const { return encoders_.size(); }
  /// Stays at its address as long as this lives.
  JointEncoder& operator[](std::size_t i) { return encoders_[i]; }
  const JointEncoder& operator[](std::size_t i) const { return encoders_[i]; }
  /// Of a joint's index; null where it has none.
  const JointEncoder* of_joint(int joint) const {
    const int e = place_of(joint);
    return e < 0 ? nullptr : &encoders_[static_cast<std::size_t>(e)];
  }

  void visit(Archive& a);

 private:
  int place_of(int joint) const;

  std::vector<int> joints_;  // by encoder
  std::vector<JointEncoder> encoders_;
};

}  // namespace navvy::vehicle
