// SPDX-License-Identifier: Apache-2.0
#include "sensor/sensor_sampler.h"

#include <cmath>
#include <utility>

#include "core/hash.h"
#include "sensor/camera/picture_scene.h"
#include "sim/timing.h"

namespace navvy::sensor {
namespace {

// Differences of times below this count as rounding [s].
constexpr double kHair = 1e-9;

std::string name_of(const Mounting& at) {
  return at.machine_handle().name() + "/" + at.description.name;
}

/// Returns the seed of a sensor's random numbers. It depends on the name alone beside the scene's
/// seed, so that another sensor changes nothing.
std::uint64_t seed_of(const sim::World& world, const std::string& name) {
  StateHash hash;
  hash.value(world.description().seed);
  hash.bytes(name.data(), name.size());
  return hash.digest();
}

Pose between(const Pose& a, const Pose& b, double share) {
  Pose out = Pose::Identity();
  out.translation() = (1 - share) * a.translation() + share * b.translation();
  out.linear() = Eigen::Quaterniond(a.linear())
                     .slerp(share, Eigen::Quaterniond(b.linear()))
                     .toRotationMatrix();
  return out;
}

template <class T>
void copy(const std::vector<double>& from, std::span<T> to) {
  for (std::size_t i = 0; i < to.size(); ++i) to[i] = static_cast<T>(from[i]);
}

}  // namespace

void SensorSampler::Reading::visit(Archive& a) {
  a("begun", begun);
  a("complete", complete);
  a("X_WS", X_WS);
  a("columns", columns);
  a("values", values);
}

SensorSampler::SensorSampler(Mounting at)
    : at_(std::move(at)), name_(name_of(at_)), random_(seed_of(at_.world, name_)) {
  instrument_ =
      std::visit([&](const auto& kind) { return make(kind, at_, random_); }, at_.description.kind);
  quantities_ = instrument_->quantities();
}

void SensorSampler::declare(sim::Publisher& out) {
  counter_ = out.declare(sim::Channel{name_ + "/readings", "1",
                                      "number of readings delivered so far: grows with each one"});
  for (const MeasuredQuantity& q : quantities_) {
    sim::ArrayChannel channel;
    channel.name = name_ + "/" + q.name;
    channel.unit = q.unit;
    channel.meaning = q.meaning;
    channel.frame = name_;
    channel.type = q.type;
    channel.shape = q.shape;
    channel.rate = at_.description.rate;
    arrays_.push_back(out.declare(std::move(channel)));
  }
}

void SensorSampler::sample(const sim::World& world, sim::Publisher& out) {
  const double now = world.time();
  const Pose X_WS = at_.link_handle().pose() * at_.description.X_LS;
  instrument_->follow();
  if (sim::sample_due(world.steps(), world.dt(), at_.description.rate)) {
    Reading next;
    next.begun = now;
    next.complete = now + instrument_->sweep();
    next.X_WS = X_WS;
    for (const MeasuredQuantity& q : quantities_) {
      std::size_t count = 1;
      for (const int length : q.shape) count *= static_cast<std::size_t>(length);
      next.values.emplace_back(count);
    }
    readings_.push_back(std::move(next));
  }
  measure(now, X_WS);
  deliver(now, out);
  before_ = now;
  X_WS_before_ = X_WS;
}

void SensorSampler::measure(double now, const Pose& X_WS) {
  // A sweep as long as the time between readings may end just after the next one has begun.
  for (Reading& reading : readings_)
    if (reading.columns < instrument_->columns()) measure(reading, now, X_WS);
}

void SensorSampler::measure(Reading& r, double now, const Pose& X_WS) {
  const int all = instrument_->columns();
  if (instrument_->looks()) at_.scene->update();
  for (; r.columns < all; ++r.columns) {
    const double t = r.begun + (all > 1 ? instrument_->sweep() * r.columns / (all - 1) : 0);
    if (t > now + kHair) return;
    const double share = now - before_ > kHair ? (t - before_) / (now - before_) : 1;
    instrument_->measure(r.columns, share >= 1 ? X_WS : between(X_WS_before_, X_WS, share),
                         r.values);
  }
  const double since = last_begun_ < 0 ? 0 : r.begun - last_begun_;
  instrument_->finish(r.values, since, random_);
  last_begun_ = r.begun;
}

void SensorSampler::deliver(double now, sim::Publisher& out) {
  while (!readings_.empty()) {
    const Reading& r = readings_.front();
    const bool complete = r.columns == instrument_->columns();
    if (!complete || r.complete + at_.description.latency > now + kHair) return;
    for (std::size_t q = 0; q < quantities_.size(); ++q) {
      const auto put = [&]<class T>(T) {
        copy(r.values[q], out.fill_late<T>(arrays_[q], r.X_WS, r.begun));
      };
      switch (quantities_[q].type) {
        case sim::ElementType::kUint8:
          put(std::uint8_t{});
          break;
        case sim::ElementType::kUint16:
          put(std::uint16_t{});
          break;
        case sim::ElementType::kInt32:
          put(std::int32_t{});
          break;
        case sim::ElementType::kFloat32:
          put(float{});
          break;
        case sim::ElementType::kFloat64:
          put(double{});
          break;
      }
    }
    out.set(counter_, ++delivered_);
    readings_.pop_front();
  }
}

void SensorSampler::visit(Archive& a) {
  a("random", random_);
  a("instrument", *instrument_);
  a("delivered", delivered_);
  a("last_begun", last_begun_);
  a("before", before_);
  a("X_WS_before", X_WS_before_);
  const std::uint64_t count = a.size("readings", readings_.size());
  if (a.loading()) readings_.assign(count, {});
  for (std::uint64_t i = 0; i < count; ++i) a.item(i, [&] { a("reading", readings_[i]); });
  if (!a.loading()) return;
  for (const Reading& r : readings_) {
    bool fits = r.values.size() == quantities_.size() && r.columns >= 0 &&
                r.columns <= instrument_->columns();
    for (std::size_t q = 0; fits && q < quantities_.size(); ++q) {
      std::size_t size = 1;
      for (const int length : quantities_[q].shape) size *= static_cast<std::size_t>(length);
      fits = r.values[q].size() == size;
    }
    a.require(fits, "readings", "a reading of another size; load it with the same sensors");
  }
  at_.scene->forget();
  at_.pictures->forget();
}

}  // namespace navvy::sensor
