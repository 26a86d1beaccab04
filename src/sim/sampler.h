// SPDX-License-Identifier: Apache-2.0
// Samplers: sensors and maps that read a world after a step and publish values. The world knows
// them by this interface only; a new one is a class of its own and one `world.add(...)`.
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

/// Gives a sampler access to the outputs of its world. Channels are declared once; each sample then
/// sets them.
class Publisher {
 public:
  /// Refers to both lists, which must outlive it. `rate` [1/s] is written into every array's
  /// channel.
  Publisher(Outputs& outputs, ArrayOutputs& arrays, double rate)
      : outputs_(outputs), arrays_(arrays), rate_(rate) {}
  Publisher(const Publisher&) = delete;
  Publisher& operator=(const Publisher&) = delete;

  /// Declares a scalar output of the world, 0 until set. Telemetry records it like any other.
  /// Returns the number to set it by.
  /// @throws InputError if the name is in use.
  int declare(Channel channel);
  /// Declares an array and returns the number to fill it by. @throws InputError if the name is in
  /// use or the shape is empty.
  int declare(ArrayChannel channel);

  /// Sets the value that the output shows from now on. `number` comes from declare. @throws
  /// std::out_of_range for another number.
  void set(int number, double value) { *numbers_.at(static_cast<std::size_t>(number)) = value; }
  /// Returns the storage of the array's next value, stamped with the time of this sample. Fill all
  /// of it before `sample` returns. `X_WF` is the present pose of its frame. @throws InputError if
  /// T is not the array's type.
  template <class T>
  std::span<T> fill(int array, const Pose& X_WF = Pose::Identity()) {
    require(array, element_type<T>());
    const std::span<std::byte> bytes = arrays_.publish(array, time_, X_WF);
    return {reinterpret_cast<T*>(bytes.data()), bytes.size() / sizeof(T)};
  }

  /// Adds the declared channels to the world, all or none: a declaration that throws leaves no
  /// trace.
  void commit();
  /// Sets the time of the present sample [s]. The world calls it.
  void stamp(double time) { time_ = time; }
  /// Visits all numbers in the order of their declaration; the world visits the arrays. Loads the
  /// same number of values only.
  void visit(Archive& a);

 private:
  /// @throws InputError if an output or array of this name exists.
  void require_new(const std::string& name) const;
  /// @throws InputError if `type` is not the array's type.
  void require(int array, ElementType type) const;

  Outputs& outputs_;
  ArrayOutputs& arrays_;
  double rate_;
  double time_ = 0;
  std::vector<Channel> new_numbers_;  ///< declared, not yet added to the world
  std::vector<ArrayChannel> new_arrays_;
  std::vector<std::unique_ptr<double>> numbers_;  ///< one address each, which the output reads
};

/// Sensor, map or measuring instrument. Reads the world and changes nothing in it.
///
/// Look up handles and channel indices once, in the constructor or in declare, and read through
/// them in sample. A sampler is deterministic: what it publishes is a function of the world and of
/// its own state, which it visits (a random generator, a delay line). A resumed run is then
/// bit-identical.
///
///   class Inclinometer final : public sim::Sampler {
///    public:
///     explicit Inclinometer(const sim::MachineHandle& machine) : base_(machine.link(0)) {}
///     std::string name() const override { return "inclinometer"; }
///     double rate() const override { return 50; }
///     void declare(sim::Publisher& out) override {
///       tilt_ = out.declare(sim::Channel{"inclinometer/tilt", "rad", "tilt of the base"});
///     }
///     void sample(const sim::World&, sim::Publisher& out) override {
///       out.set(tilt_, std::acos(base_.pose().linear()(2, 2)));
///     }
///
///    private:
///     sim::LinkHandle base_;
///     int tilt_ = -1;
///   };
class Sampler {
 public:
  virtual ~Sampler() = default;
  /// Returns its name for messages and snapshots, unique in its world.
  virtual std::string name() const = 0;
  /// Returns the samples per second of simulated time; 0: after every step. Called once.
  virtual double rate() const = 0;
  /// Declares its channels. Called once, when it is added.
  virtual void declare(Publisher& out) = 0;
  /// Takes a sample. Called when it is added and after each step in which a sample is due.
  virtual void sample(const World& world, Publisher& out) = 0;
  /// Visits its own state, if any. The world visits what it published.
  virtual void visit(Archive&) {}
};

/// Sampler in its world, which owns it. Clients use World::add and the outputs.
class SamplerSlot {
 public:
  /// Declares the sampler's channels. @throws InputError for a rate that is not finite or negative,
  /// or a name in use.
  SamplerSlot(std::unique_ptr<Sampler> sampler, Outputs& outputs, ArrayOutputs& arrays);

  /// Returns the sampler's name.
  const std::string& name() const { return name_; }
  /// Returns whether step `step` of `dt` [s] is the nearest to a multiple of the period
  /// (sim/timing.h).
  bool due(std::uint64_t step, double dt) const;
  /// Takes a sample stamped `time` [s].
  void sample(const World& world, double time);
  /// Visits the published numbers and the sampler's own state. Loads only into a slot of the same
  /// name.
  void visit(Archive& a);

 private:
  std::unique_ptr<Sampler> sampler_;
  std::string name_;
  double rate_;
  Publisher publisher_;
};

}  // namespace navvy::sim
