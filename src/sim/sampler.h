// SPDX-License-Identifier: Apache-2.0
// What looks at a world after a step and publishes what it saw: sensors, maps. The world knows them
// by this interface only; a new one is a class of its own and `world.add(...)`, and nothing else
// changes.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/archive.h"
#include "core/math.h"
#include "sim/array_outputs.h"
#include "sim/channels.h"

namespace navvy::sim {

class World;

/// One sampler's way to the outputs of its world. Channels are declared once; each sample then sets
/// them.
class Publisher {
 public:
  /// Both lists must outlive it. `rate` [1/s] is written into every array's channel.
  Publisher(Outputs& outputs, ArrayOutputs& arrays, double rate)
      : outputs_(outputs), arrays_(arrays), rate_(rate) {}
  Publisher(const Publisher&) = delete;
  Publisher& operator=(const Publisher&) = delete;

  /// A new scalar output of the world, 0 until set; telemetry records it as any other. Returns the
  /// number to set it by.
  /// @throws InputError when the name is in use.
  int declare(Channel channel);
  /// A new array. Returns the number to fill it by. @throws InputError when the name is in use or
  /// the shape is empty.
  int declare(ArrayChannel channel);

  /// The value that the output shows from now on. `number` from declare; std::out_of_range for
  /// another.
  void set(int number, double value) { *numbers_.at(static_cast<std::size_t>(number)) = value; }
  /// Storage of the array's next value, stamped with the time of this sample: fill all of it before
  /// `sample` returns. `X_WF` is where its frame is now. @throws InputError when T is not the
  /// array's type.
  template <class T>
  std::span<T> fill(int array, const Pose& X_WF = Pose::Identity()) {
    require(array, element_type<T>());
    const std::span<std::byte> bytes = arrays_.publish(array, time_, X_WF);
    return {reinterpret_cast<T*>(bytes.data()), bytes.size() / sizeof(T)};
  }

  /// Makes what was declared known to the world, all of it or nothing: a declaration that throws
  /// leaves no trace.
  void commit();
  /// Time of the sample that is being taken [s]; set by the world.
  void stamp(double time) { time_ = time; }
  /// All numbers in the order of their declaration; arrays are visited with all others. Loads as
  /// many only.
  void visit(Archive& a);

 private:
  void require_new(const std::string& name) const;
  void require(int array, ElementType type) const;

  Outputs& outputs_;
  ArrayOutputs& arrays_;
  double rate_;
  double time_ = 0;
  std::vector<Channel> new_numbers_;  ///< declared, not yet known to the world
  std::vector<ArrayChannel> new_arrays_;
  /// Each at an address of its own that the output reads.
  std::vector<std::unique_ptr<double>> numbers_;
};

/// A sensor, a map, a measuring instrument. Its handles and channel indices are looked up once, in
/// its constructor or in declare, and read in sample. Reads the world, changes nothing of it.
///
/// Deterministic: what it publishes is a function of the world and of its own state, which it
/// visits (a random generator, a delay line); a resumed run then goes on to the same bits.
class Sampler {
 public:
  virtual ~Sampler() = default;
  /// For messages and snapshots; unique in its world.
  virtual std::string name() const = 0;
  /// Samples per second of simulated time; 0: after every step. Asked once.
  virtual double rate() const = 0;
  /// Called once, when it is added.
  virtual void declare(Publisher& out) = 0;
  /// Called when it is added and after each step in which a sample fell due.
  virtual void sample(const World& world, Publisher& out) = 0;
  /// Only for a state of its own; what it published is visited by the world.
  virtual void visit(Archive&) {}
};

/// Owned by the world; clients see World::add and the outputs.
/// A sampler in its world.
class SamplerSlot {
 public:
  /// Declares the sampler's channels. @throws InputError for a rate that is not finite or below 0,
  /// or a name in use.
  SamplerSlot(std::unique_ptr<Sampler> sampler, Outputs& outputs, ArrayOutputs& arrays);

  const std::string& name() const { return name_; }
  /// True when step `step` of `dt` [s] is the nearest to a multiple of the period (sim/timing.h).
  bool due(std::uint64_t step, double dt) const;
  /// Takes a sample stamped `time` [s].
  void sample(const World& world, double time);
  /// The numbers it published, and its own state. Loads into a slot of the same name only.
  void visit(Archive& a);

 private:
  std::unique_ptr<Sampler> sampler_;
  std::string name_;
  double rate_;
  Publisher publisher_;
};

}  // namespace navvy::sim
