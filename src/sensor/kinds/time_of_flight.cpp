// SPDX-License-Identifier: Apache-2.0
// Time-of-flight camera: the phase of the light that returns to a pixel from all its rays.
#include <cmath>
#include <complex>

#include "sensor/beam_errors.h"
#include "sensor/instrument.h"
#include "sensor/pixels.h"

namespace navvy::sensor {
namespace {

constexpr double kLight = 299792458;  // [m/s]

class TimeOfFlightInstrument final : public Instrument {
 public:
  TimeOfFlightInstrument(const scene::TimeOfFlight& kind, const Mounting& at, Random& random)
      : kind_(kind),
        scene_(at.scene),
        pixels_(kind.width, kind.height, kind.fov),
        // The range was compared with the true distance; noise may fold it to any value.
        errors_(kind.noise, kind.errors, 0, ambiguity(), kind.range.resolution, random) {}

  bool looks() const override { return true; }
  std::vector<MeasuredQuantity> quantities() const override {
    const std::vector<int> shape = {kind_.height, kind_.width};
    return {{"distances", "m", "distances along the pixels' rays, modulo c / (2 f)",
             sim::ElementType::kFloat32, shape},
            {"amplitudes", "1", "returned light; 1: from all rays of the pixel at 1 m",
             sim::ElementType::kFloat32, shape}};
  }
  void measure(int, const Pose& X_WS, Values& out) override {
    std::size_t i = 0;
    for (int row = 0; row < kind_.height; ++row)
      for (int column = 0; column < kind_.width; ++column, ++i) {
        const std::complex<double> light = light_of(column, row, X_WS);
        const double turn = std::arg(light) / (2 * kPi);
        out[1][i] = std::abs(light);
        out[0][i] = out[1][i] > 0 ? (turn - std::floor(turn)) * ambiguity() : kTooFar;
      }
  }
  void finish(Values& out, double dt, Random& random) override {
    errors_.advance(dt, random);
    for (double& distance : out[0]) distance = errors_.apply(distance, random);
  }
  void visit(Archive& a) override { a("errors", errors_); }

 private:
  /// Returns the distance after which the phase repeats [m].
  double ambiguity() const { return kLight / (2 * kind_.modulation); }
  /// Returns the sum of the light that returns to a pixel, with its phase. Where the rays of a
  /// pixel meet near and far things, the sum has a phase in between: a flying pixel.
  std::complex<double> light_of(int column, int row, const Pose& X_WS) const {
    std::complex<double> sum = 0;
    const int n = kind_.rays;
    for (int a = 0; a < n; ++a)
      for (int b = 0; b < n; ++b) {
        const Vec3 d_S = pixels_.ray(column + (a + 0.5) / n, row + (b + 0.5) / n).normalized();
        const double t =
            distance_along(*scene_, X_WS.translation(), X_WS.linear() * d_S, kind_.range.max);
        if (!std::isfinite(t) || t < kind_.range.min) continue;
        // Light spreads with the square of the distance.
        sum += std::polar(1 / (n * n * t * t), 2 * kPi * t / ambiguity());
      }
    return sum;
  }

  scene::TimeOfFlight kind_;
  std::shared_ptr<RayScene> scene_;
  Pixels pixels_;
  BeamDisturbance errors_;
};

}  // namespace

std::unique_ptr<Instrument> make(const scene::TimeOfFlight& kind, const Mounting& at,
                                 Random& random) {
  return std::make_unique<TimeOfFlightInstrument>(kind, at, random);
}

}  // namespace navvy::sensor
