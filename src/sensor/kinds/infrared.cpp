// SPDX-License-Identifier: Apache-2.0
// Infrared distance sensor: the mean distance over its spot.
#include <cmath>

#include "sensor/beam_errors.h"
#include "sensor/instrument.h"

namespace navvy::sensor {
namespace {

// Rays on the edge of the spot, beside the one in the middle.
constexpr int kEdgeRays = 6;

class InfraredInstrument final : public Instrument {
 public:
  InfraredInstrument(const scene::Infrared& kind, const Mounting& at, Random& random)
      : kind_(kind),
        scene_(at.scene),
        errors_(kind.noise, kind.errors, kind.range.min, kind.range.max, kind.range.resolution,
                random) {
    rays_.emplace_back(1, 0, 0);
    // At 0.7 of the half angle, the ring represents the outer half of the spot's area.
    const double angle = 0.35 * kind_.spot;
    for (int i = 0; kind_.spot > 0 && i < kEdgeRays; ++i) {
      const double turn = 2 * kPi * i / kEdgeRays;
      rays_.emplace_back(std::cos(angle), std::sin(angle) * std::cos(turn),
                         std::sin(angle) * std::sin(turn));
    }
  }

  bool looks() const override { return true; }
  std::vector<MeasuredQuantity> quantities() const override {
    return {{"range",
             "m",
             "distance; inf: beyond the range, -inf: below it, NaN: lost",
             sim::ElementType::kFloat32,
             {1}}};
  }
  void measure(int, const Pose& X_WS, Values& out) override {
    double sum = 0;
    int count = 0;
    for (const Vec3& d_S : rays_) {
      const double t =
          distance_along(*scene_, X_WS.translation(), X_WS.linear() * d_S, kind_.range.max);
      if (!std::isfinite(t)) continue;
      sum += t;
      ++count;
    }
    // Light of less than half the spot is too weak.
    out[0][0] = 2 * count > static_cast<int>(rays_.size()) ? sum / count : kTooFar;
  }
  void finish(Values& out, double dt, Random& random) override {
    errors_.advance(dt, random);
    out[0][0] = errors_.apply(out[0][0], random);
  }
  void visit(Archive& a) override { a("errors", errors_); }

 private:
  scene::Infrared kind_;
  std::shared_ptr<RayScene> scene_;
  BeamDisturbance errors_;
  std::vector<Vec3> rays_;  ///< directions in S
};

}  // namespace

std::unique_ptr<Instrument> make(const scene::Infrared& kind, const Mounting& at, Random& random) {
  return std::make_unique<InfraredInstrument>(kind, at, random);
}

}  // namespace navvy::sensor
