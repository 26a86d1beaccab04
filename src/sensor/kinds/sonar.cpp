// SPDX-License-Identifier: Apache-2.0
// Ultrasonic sensor: the echo of the closest thing in the cone comes first.
#include <algorithm>
#include <cmath>

#include "sensor/beam_errors.h"
#include "sensor/instrument.h"

namespace navvy::sensor {
namespace {

class SonarInstrument final : public Instrument {
 public:
  SonarInstrument(const scene::Sonar& kind, const Mounting& at, Random& random)
      : kind_(kind),
        scene_(at.scene),
        errors_(kind.noise, kind.errors, kind.min, kind.max, 0, random) {
    // Rays at equal areas of the cap, each turned by the golden angle: the first is the axis.
    const double half = std::atan2(kind_.radius, kind_.max), golden = kPi * (3 - std::sqrt(5.0));
    for (int i = 0; i < kind_.beams; ++i) {
      const double share = kind_.beams > 1 ? static_cast<double>(i) / (kind_.beams - 1) : 0;
      const double x = 1 - share * (1 - std::cos(half)), across = std::sqrt(1 - x * x);
      rays_.emplace_back(x, across * std::cos(i * golden), across * std::sin(i * golden));
    }
  }

  bool looks() const override { return true; }
  std::vector<MeasuredQuantity> quantities() const override {
    return {{"range",
             "m",
             "distance; inf: beyond the range, -inf: below it, NaN: lost echo",
             sim::ElementType::kFloat32,
             {1}}};
  }
  void measure(int, const Pose& X_WS, Values& out) override {
    double closest = kTooFar;
    for (const Vec3& d_S : rays_)
      closest = std::min(closest, distance_along(*scene_, X_WS.translation(), X_WS.linear() * d_S,
                                                 std::min(closest, kind_.max)));
    out[0][0] = closest;
  }
  void finish(Values& out, double dt, Random& random) override {
    errors_.advance(dt, random);
    out[0][0] = errors_.apply(out[0][0], random);
  }
  void visit(Archive& a) override { a("errors", errors_); }

 private:
  scene::Sonar kind_;
  std::shared_ptr<RayScene> scene_;
  BeamDisturbance errors_;
  std::vector<Vec3> rays_;  ///< directions in S
};

}  // namespace

std::unique_ptr<Instrument> make(const scene::Sonar& kind, const Mounting& at, Random& random) {
  return std::make_unique<SonarInstrument>(kind, at, random);
}

}  // namespace navvy::sensor
