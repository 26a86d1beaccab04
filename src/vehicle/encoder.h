// SPDX-License-Identifier: Apache-2.0
// Encoders of a machine's joints: counters of a few bits, as a real robot reports them to its
// controller. Independent of the engine, so that a controller cannot see which engine moves the
// machine.
#pragma once

#include <cstdint>
#include <vector>

#include "core/archive.h"
#include "core/random.h"
#include "scene/machine.h"
#include "vehicle/physics_engine.h"

namespace navvy::vehicle {

/// Incremental encoder [docs/machines.md, encoders]. Starts at 0 at the joint's position, counts up
/// as the joint turns positively and down as it turns back, and wraps at 2^bits.
class JointEncoder {
 public:
  /// Largest slip that can be injected as a fault.
  static constexpr double kMostSlip = 0.9;

  /// Starts at `position` [rad]. `seed` decides which counts are missed.
  JointEncoder(const scene::Encoder& about, double position, std::uint64_t seed);

  /// Moves the joint to `position` [rad]. The path since the last call does not matter.
  void advance(double position);
  /// Returns the register, 0 to 2^bits - 1.
  std::uint64_t counts() const;
  /// Returns the encoder's data.
  const scene::Encoder& about() const { return about_; }

  /// Injects the slip s into all further counts: they report w r where w r (1 - s) was rolled.
  /// Clamped to +-kMostSlip.
  void set_slip(double slip);
  /// Returns the injected slip [-].
  double slip() const { return slip_; }
  /// Injects a random loss of this share of all further counts, in both directions. Clamped to 0 to
  /// 1.
  void set_missed(double share);
  /// Returns the injected share of lost counts [-].
  double missed() const { return missed_; }

  /// Visits register, faults and the random generator.
  void visit(Archive& a);

 private:
  /// Returns how many of `edges` counts are lost, drawn at random.
  std::int64_t lost_of(std::int64_t edges);

  scene::Encoder about_;
  double position_ = 0;     // [rad] at the last call
  double turned_ = 0;       // [counts] since the start, with fractions
  std::int64_t edges_ = 0;  // whole counts of turned_
  // Counts that were not missed, modulo 2^64. The low bits are the register.
  std::uint64_t counter_ = 0;
  double slip_ = 0, missed_ = 0;
  Random dice_;
};

/// Encoders of one machine, in the order of its file.
class Encoders {
 public:
  /// Reads the start positions of machine `index` of the engine. `seed` belongs to this machine
  /// alone.
  Encoders(const scene::Machine& machine, const PhysicsEngine& engine, int index,
           std::uint64_t seed);

  /// Updates all encoders. Call it after every step of the engine.
  void advance(const PhysicsEngine& engine, int index);
  /// Returns the number of encoders.
  std::size_t size() const { return encoders_.size(); }
  /// Returns an encoder. Its address never changes.
  JointEncoder& operator[](std::size_t i) { return encoders_[i]; }
  const JointEncoder& operator[](std::size_t i) const { return encoders_[i]; }
  /// Returns the encoder of a joint, null if it has none.
  const JointEncoder* of_joint(int joint) const {
    const int e = place_of(joint);
    return e < 0 ? nullptr : &encoders_[static_cast<std::size_t>(e)];
  }

  /// Visits all encoders.
  void visit(Archive& a);

 private:
  /// Returns the index of a joint's encoder, -1 if it has none.
  int place_of(int joint) const;

  std::vector<int> joints_;  // by encoder
  std::vector<JointEncoder> encoders_;
};

}  // namespace navvy::vehicle
