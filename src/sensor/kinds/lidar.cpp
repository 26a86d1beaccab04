// SPDX-License-Identifier: Apache-2.0
// Laser scanner: a column holds the beams of all rings at one angle.
#include <cmath>

#include "sensor/beam_errors.h"
#include "sensor/instrument.h"

namespace navvy::sensor {
namespace {

class LidarInstrument final : public Instrument {
 public:
  LidarInstrument(const scene::Lidar& kind, const Mounting& at, Random& random)
      : kind_(kind),
        scene_(at.scene),
        errors_(kind.noise, kind.errors, kind.range.min, kind.range.max, kind.range.resolution,
                random) {
    for (int ring = 0; ring < kind_.vertical.samples; ++ring) {
      const double angle = kind_.vertical.angle(ring);
      elevations_.emplace_back(std::cos(angle), std::sin(angle));
    }
  }

  bool looks() const override { return true; }
  std::vector<MeasuredQuantity> quantities() const override {
    std::vector<int> shape = {kind_.horizontal.samples};
    if (kind_.vertical.samples > 1) shape.insert(shape.begin(), kind_.vertical.samples);
    return {{"ranges", "m", "distances; inf: beyond the range, -inf: below it, NaN: dropped",
             sim::ElementType::kFloat32, shape}};
  }
  int columns() const override { return kind_.horizontal.samples; }
  double sweep() const override { return kind_.sweep; }

  void measure(int column, const Pose& X_WS, Values& out) override {
    const double angle = kind_.horizontal.angle(column);
    const Vec2 ahead(std::cos(angle), std::sin(angle));
    for (std::size_t ring = 0; ring < elevations_.size(); ++ring) {
      const Vec2& e = elevations_[ring];
      const Vec3 d_S(e.x() * ahead.x(), e.x() * ahead.y(), e.y());
      out[0][ring * static_cast<std::size_t>(columns()) + static_cast<std::size_t>(column)] =
          distance_along(*scene_, X_WS.translation(), X_WS.linear() * d_S, kind_.range.max);
    }
  }
  void finish(Values& out, double dt, Random& random) override {
    errors_.advance(dt, random);
    for (double& distance : out[0]) distance = errors_.apply(distance, random);
  }
  void visit(Archive& a) override { a("errors", errors_); }

 private:
  scene::Lidar kind_;
  std::shared_ptr<RayScene> scene_;
  BeamDisturbance errors_;
  std::vector<Vec2> elevations_;  ///< cosine and sine of each ring's angle
};

}  // namespace

std::unique_ptr<Instrument> make(const scene::Lidar& kind, const Mounting& at, Random& random) {
  return std::make_unique<LidarInstrument>(kind, at, random);
}

}  // namespace navvy::sensor
