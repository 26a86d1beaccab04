// SPDX-License-Identifier: Apache-2.0
// Satellite receiver. Beams to the satellites decide whether it has a fix.
#include <cmath>

#include "sensor/beam_errors.h"
#include "sensor/instrument.h"

namespace navvy::sensor {
namespace {

// Satellites that a position and the time need.
constexpr int kForFix = 4;
// Things farther away than this hide no satellite [m].
constexpr double kSky = 500;

/// Errors of a horizontal and a vertical value.
struct SensingNoise {
  Noise x, y, z;

  SensingNoise(const scene::Gnss::Sensing& sensing, Random& random)
      : x(sensing.horizontal.noise, random),
        y(sensing.horizontal.noise, random),
        z(sensing.vertical.noise, random) {}
  void apply(std::vector<double>& values, double dt, Random& random) {
    std::size_t i = 0;
    for (Noise* part : {&x, &y, &z}) {
      part->advance(dt, random);
      values[i] = part->apply(values[i], random);
      ++i;
    }
  }
  void visit(Archive& a) {
    a("x", x);
    a("y", y);
    a("z", z);
  }
};

class GnssInstrument final : public Instrument {
 public:
  GnssInstrument(const scene::Gnss& kind, const Mounting& at, Random& random)
      : kind_(kind),
        at_(at),
        link_(at.link_handle()),
        position_(kind.position, random),
        velocity_(kind.velocity, random) {
    // Equal areas of the sky above the mask, each turned by the golden angle.
    const double golden = kPi * (3 - std::sqrt(5.0)), lowest = std::sin(kind_.mask);
    for (int i = 0; i < kind_.satellites; ++i) {
      const double z = lowest + (1 - lowest) * (i + 0.5) / kind_.satellites;
      const double across = std::sqrt(1 - z * z);
      sky_.emplace_back(across * std::cos(i * golden), across * std::sin(i * golden), z);
    }
  }

  bool looks() const override { return true; }
  std::vector<MeasuredQuantity> quantities() const override {
    return {{"position",
             "m",
             "position in the world; NaN without a fix",
             sim::ElementType::kFloat64,
             {3}},
            {"velocity",
             "m/s",
             "velocity in the world; NaN without a fix",
             sim::ElementType::kFloat64,
             {3}},
            {"status",
             "1",
             "1 with a fix, else 0; number of visible satellites",
             sim::ElementType::kInt32,
             {2}}};
  }
  void measure(int, const Pose& X_WS, Values& out) override {
    const Vec3 p = X_WS.translation();
    int visible = 0;
    for (const Vec3& d : sky_)
      if (!at_.scene->first_hit(p, d, kSky)) ++visible;
    const bool clear = visible >= kForFix;
    // At the start of a run the receiver has its fix, if it can have one.
    if (clear && first_)
      waited_ = kind_.reacquire;
    else
      waited_ = clear && clear_ ? waited_ + 1 / at_.description.rate : 0;
    first_ = false;
    clear_ = clear;
    const bool fix = clear && waited_ >= kind_.reacquire;
    const vehicle::LinkState state = link_.state();
    const Vec3 v = state.v_WL + state.w_WL.cross(p - state.X_WL.translation());
    out[0] = {p.x(), p.y(), p.z()};
    out[1] = {v.x(), v.y(), v.z()};
    out[2] = {fix ? 1.0 : 0.0, static_cast<double>(visible)};
  }
  void finish(Values& out, double dt, Random& random) override {
    // The errors go on without a fix, so that it does not change those of later readings.
    position_.apply(out[0], dt, random);
    velocity_.apply(out[1], dt, random);
    if (out[2][0] > 0) return;
    out[0].assign(3, kDropped);
    out[1].assign(3, kDropped);
  }
  void visit(Archive& a) override {
    a("position", position_);
    a("velocity", velocity_);
    a("waited", waited_);
    a("clear", clear_);
    a("first", first_);
  }

 private:
  scene::Gnss kind_;
  Mounting at_;
  sim::LinkHandle link_;
  SensingNoise position_, velocity_;
  std::vector<Vec3> sky_;  ///< directions to the satellites in W
  double waited_ = 0;      ///< time for which enough satellites have been visible [s]
  bool clear_ = false;     ///< true if enough were visible at the last reading
  bool first_ = true;      ///< true before the first reading
};

}  // namespace

std::unique_ptr<Instrument> make(const scene::Gnss& kind, const Mounting& at, Random& random) {
  return std::make_unique<GnssInstrument>(kind, at, random);
}

}  // namespace navvy::sensor
