// SPDX-License-Identifier: Apache-2.0
// Encoders of a machine's joints: wrapping counters of a few bits, as a real robot reports them to
// its controller. They are independent of the physics engine, so a controller cannot distinguish
// which engine moves the machine.
#pragma once

#include <cstdint>
#include <vector>

#include "core/archive.h"
#include "core/random.h"
#include "scene/machine.h"
#include "vehicle/physics_engine.h"

namespace navvy::vehicle {

/// Incremental encoder of one joint [docs/machines.md, encoders].
///
/// Its register is 0 at the joint's initial position. It counts up as the joint turns in the
/// positive direction, counts down as the joint turns back, and wraps at 2^bits.
class JointEncoder {
 public:
  /// Largest magnitude of the slip that can be injected as an error [-].
  static constexpr double kMostSlip = 0.9;

  /// Makes an encoder with the properties `about` whose register is 0 at the joint position
  /// `position` [rad]. `seed` determines which counts are lost when losses are injected.
  JointEncoder(const scene::Encoder& about, double position, std::uint64_t seed);

  /// Counts the rotation of the joint from its last position to `position` [rad]. The path between
  /// the two does not matter.
  void advance(double position);
  /// Returns the value of the encoder's register, 0 to 2^bits - 1.
  std::uint64_t counts() const;
  /// Returns the properties of this encoder as given in the scene.
  const scene::Encoder& about() const { return about_; }

  /// Injects wheel slip into all further counts: the encoder counts 1 / (1 - `slip`) times the
  /// rotation of the joint. `slip` [-] is clamped to +-kMostSlip; 0 disables this error.
  void set_slip(double slip);
  /// Returns the injected slip [-].
  double slip() const { return slip_; }
  /// Makes the encoder lose a random share of all further counts, in both directions. `share` [-]
  /// is clamped to 0 to 1; 0 disables this error.
  void set_missed(double share);
  /// Returns the injected share of lost counts [-].
  double missed() const { return missed_; }

  /// Saves, loads or hashes the encoder's register, injected errors and random generator.
  void visit(Archive& a);

 private:
  /// Draws at random how many of `edges` further counts are lost, and returns that number.
  std::int64_t lost_of(std::int64_t edges);

  /// Properties of this encoder as given in the scene.
  scene::Encoder about_;
  /// Joint position at the last call of advance() [rad].
  double position_ = 0;
  /// Rotation since the start, slip included, in counts with fractions.
  double turned_ = 0;
  /// Whole counts of `turned_`, rounded down.
  std::int64_t edges_ = 0;
  /// Sum of all counts that were not lost, modulo 2^64. Its low bits are the register.
  std::uint64_t counter_ = 0;
  /// Injected slip, and injected share of lost counts [-].
  double slip_ = 0, missed_ = 0;
  /// Random generator that selects the lost counts.
  Random dice_;
};

/// All encoders of one machine, in the order of the machine's file.
class Encoders {
 public:
  /// Makes the encoders of `machine`, which is machine `index` of `engine`, at the current
  /// positions of its joints. `seed` must differ from machine to machine; each encoder derives its
  /// own seed from it.
  Encoders(const scene::Machine& machine, const PhysicsEngine& engine, int index,
           std::uint64_t seed);

  /// Updates all encoders from the joint positions of machine `index` of `engine`. Call it after
  /// every step of the engine.
  void advance(const PhysicsEngine& engine, int index);
  /// Returns the number of encoders of this machine.
  std::size_t size() const { return encoders_.size(); }
  /// Returns the encoder with index `i`, which must be less than size(). The reference remains
  /// valid as long as this object exists.
  JointEncoder& operator[](std::size_t i) { return encoders_[i]; }
  /// Returns the encoder with index `i`, which must be less than size().
  const JointEncoder& operator[](std::size_t i) const { return encoders_[i]; }
  /// Returns the encoder of the joint with index `joint`; null if that joint has no encoder.
  const JointEncoder* of_joint(int joint) const {
    const int e = place_of(joint);
    return e < 0 ? nullptr : &encoders_[static_cast<std::size_t>(e)];
  }

  /// Saves, loads or hashes all encoders. A loaded archive must have the same number of encoders.
  void visit(Archive& a);

 private:
  /// Returns the encoder's index for a joint index, -1 if the joint has no encoder.
  int place_of(int joint) const;

  /// Joint index of each encoder; -1 for a joint name that the machine does not have.
  std::vector<int> joints_;
  /// Encoders in the order of the machine's file.
  std::vector<JointEncoder> encoders_;
};

}  // namespace navvy::vehicle
