// SPDX-License-Identifier: Apache-2.0
// Samplers: sensors and maps that read a world after a step and publish values. The world uses them
// only through the interface Sampler; `world.add(...)` adds one.
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

/// Gives a sampler write access to its outputs in the world. The sampler declares each output once
/// and then sets its value in every sample.
class Publisher {
 public:
  /// Creates a publisher that adds scalar outputs to `outputs` and arrays to `arrays`; both lists
  /// must outlive it. `rate` [1/s] is stored as the publication rate of every array.
  /// `hashed` is Sampler::hashed.
  Publisher(Outputs& outputs, ArrayOutputs& arrays, double rate, bool hashed = true)
      : outputs_(outputs), arrays_(arrays), rate_(rate), hashed_(hashed) {}
  Publisher(const Publisher&) = delete;
  Publisher& operator=(const Publisher&) = delete;

  /// Declares a scalar output, which is 0 until it is set; telemetry records it like any other
  /// output. Returns the index of the output for `set`. The output becomes part of the world with
  /// `commit`.
  /// @throws InputError if the name is in use.
  int declare(Channel channel);
  /// Declares an array and returns its index for `fill`. The array becomes part of the world with
  /// `commit`.
  /// @throws InputError if the name is in use or the shape has no elements.
  int declare(ArrayChannel channel);

  /// Sets the value that a scalar output has from now on. `number` is the index that `declare`
  /// returned.
  /// @throws std::out_of_range for any other index.
  void set(int number, double value) { *numbers_.at(static_cast<std::size_t>(number)) = value; }
  /// Publishes a new value of an array and returns its storage; the caller must fill all elements
  /// before `sample` returns. `array` is the index that `declare` returned; `X_WF` is the current
  /// pose in W of the array's frame F. The value is stamped with the time of the current sample.
  /// @throws InputError if T is not the array's element type.
  template <class T>
  std::span<T> fill(int array, const Pose& X_WF = Pose::Identity()) {
    require(array, element_type<T>());
    const std::span<std::byte> bytes = arrays_.publish(array, time_, X_WF, time_);
    return {reinterpret_cast<T*>(bytes.data()), bytes.size() / sizeof(T)};
  }

  /// Publishes an array as `fill` does, for a value that was measured at the earlier time
  /// `measured` [s]: the value is stamped with that time, and delivered at the current one.
  template <class T>
  std::span<T> fill_late(int array, const Pose& X_WF, double measured) {
    require(array, element_type<T>());
    const std::span<std::byte> bytes = arrays_.publish(array, measured, X_WF, time_);
    return {reinterpret_cast<T*>(bytes.data()), bytes.size() / sizeof(T)};
  }

  /// Adds all declared outputs to the world. Until then a failed declaration leaves the world
  /// unchanged.
  void commit();
  /// Sets the simulated time of the current sample [s]. Only the world calls this.
  void stamp(double time) { time_ = time; }
  /// Visits the values of all scalar outputs in the order of their declaration; the world visits
  /// the arrays. Loading requires the same number of scalar outputs.
  void visit(Archive& a);

 private:
  /// Checks that no output or array of this name exists or was declared.
  /// @throws InputError if one does.
  void require_new(const std::string& name) const;
  /// Checks that `type` is the array's element type.
  /// @throws InputError if it is not.
  void require(int array, ElementType type) const;

  /// List that receives the scalar outputs.
  Outputs& outputs_;
  /// List that receives the arrays.
  ArrayOutputs& arrays_;
  /// Publication rate of the sampler's arrays [1/s]; 0 means one publication after every step.
  double rate_;
  /// True if the arrays are part of the hash of the world's state.
  bool hashed_;
  /// Simulated time of the current sample [s].
  double time_ = 0;
  /// Scalar outputs that are declared but not yet part of the world.
  std::vector<Channel> new_numbers_;
  /// Arrays that are declared but not yet part of the world.
  std::vector<ArrayChannel> new_arrays_;
  /// Values of all scalar outputs in the order of declaration. Each has a fixed address, from which
  /// the world's output reads it.
  std::vector<std::unique_ptr<double>> numbers_;
};

/// Base class of sensors, maps and measuring instruments. A sampler reads the world and publishes
/// values; it must not change the world.
///
/// Implementations should look up handles and channel indices once, in the constructor or in
/// `declare`, and use them in `sample`. A sampler must be deterministic: the published values may
/// depend only on the world and on the sampler's own state (a random generator, a delay line),
/// which `visit` must cover. A resumed run is then bit-identical.
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
  /// Returns the sampler's name for messages and snapshots. It must be unique in the world.
  virtual std::string name() const = 0;
  /// Returns the number of samples per second of simulated time; 0 means one sample after every
  /// step. Called once.
  virtual double rate() const = 0;
  /// Declares all outputs of the sampler in `out`. Called once, when the sampler is added to a
  /// world.
  virtual void declare(Publisher& out) = 0;
  /// Takes a sample: reads `world` and sets the outputs through `out`. Called when the sampler is
  /// added, and after each step in which a sample is due.
  virtual void sample(const World& world, Publisher& out) = 0;
  /// Returns true if state and values of the sampler are part of the hash of the world's state.
  /// Only a sampler that a run with and without it must agree on returns false. Snapshots contain
  /// it either way.
  virtual bool hashed() const { return true; }
  /// Visits the sampler's own state, such as a random generator or a delay line. The world visits
  /// the published values. Samplers without state need not override this.
  virtual void visit(Archive&) {}
};

/// A sampler within its world, which owns it, together with its rate and outputs. Clients use
/// World::add and the world's outputs instead.
class SamplerSlot {
 public:
  /// Takes ownership of `sampler` and adds its outputs to `outputs` and `arrays`.
  /// @throws InputError for a rate that is negative or not finite, or a name that is in use.
  SamplerSlot(std::unique_ptr<Sampler> sampler, Outputs& outputs, ArrayOutputs& arrays);

  /// Returns the sampler's name.
  const std::string& name() const { return name_; }
  /// Returns Sampler::hashed.
  bool hashed() const { return sampler_->hashed(); }
  /// Returns true if a sample is due in step number `step` with steps of `dt` [s], that is, if that
  /// step is the nearest one to a sample time (sim/timing.h).
  bool due(std::uint64_t step, double dt) const;
  /// Takes a sample of `world` and stamps it with the simulated time `time` [s].
  void sample(const World& world, double time);
  /// Visits the sampler's published scalar values and its own state. Loading requires a sampler of
  /// the same name.
  void visit(Archive& a);

 private:
  std::unique_ptr<Sampler> sampler_;
  std::string name_;
  /// Samples per second of simulated time; 0: after every step.
  double rate_;
  Publisher publisher_;
};

}  // namespace navvy::sim
