// SPDX-License-Identifier: Apache-2.0
// Cameras for depths and labels: one ray through the middle of each pixel.
#include <cmath>

#include "sensor/beam_errors.h"
#include "sensor/instrument.h"
#include "sensor/pixels.h"

namespace navvy::sensor {
namespace {

/// Calls `visit(index, ray_S, hit)` for each pixel; `ray_S` has x = 1.
template <class Visit>
void look(const RayScene& scene, const Pixels& pixels, double far, const Pose& X_WS,
          const Visit& visit) {
  std::size_t i = 0;
  for (int row = 0; row < pixels.height; ++row)
    for (int column = 0; column < pixels.width; ++column, ++i) {
      const Vec3 ray_S = pixels.ray(column + 0.5, row + 0.5);
      const double length = ray_S.norm();
      visit(i, length,
            scene.first_hit(X_WS.translation(), X_WS.linear() * (ray_S / length), far * length));
    }
}

class DepthInstrument final : public Instrument {
 public:
  DepthInstrument(const scene::DepthCamera& kind, const Mounting& at, Random& random)
      : kind_(kind),
        scene_(at.scene),
        pixels_(kind.width, kind.height, kind.fov),
        errors_(kind.noise, {}, kind.near, kind.far, 0, random) {}

  bool looks() const override { return true; }
  std::vector<MeasuredQuantity> quantities() const override {
    return {{"depth",
             "m",
             "depths along x of the sensor; inf: beyond the range, -inf: below it",
             sim::ElementType::kFloat32,
             {kind_.height, kind_.width}}};
  }
  void measure(int, const Pose& X_WS, Values& out) override {
    look(*scene_, pixels_, kind_.far, X_WS,
         [&](std::size_t i, double length, const std::optional<BeamHit>& hit) {
           out[0][i] = hit ? hit->distance / length : kTooFar;
         });
  }
  void finish(Values& out, double dt, Random& random) override {
    errors_.advance(dt, random);
    for (double& depth : out[0]) depth = errors_.apply(depth, random);
  }
  void visit(Archive& a) override { a("errors", errors_); }

 private:
  scene::DepthCamera kind_;
  std::shared_ptr<RayScene> scene_;
  Pixels pixels_;
  BeamDisturbance errors_;
};

class LabelInstrument final : public Instrument {
 public:
  LabelInstrument(const scene::DepthCamera& kind, const Mounting& at)
      : kind_(kind), scene_(at.scene), pixels_(kind.width, kind.height, kind.fov) {}

  bool looks() const override { return true; }
  std::vector<MeasuredQuantity> quantities() const override {
    return {{"labels",
             "1",
             "0 nothing, 1 ground, 2 soil in the air or in a tool, 3 + i machine i",
             sim::ElementType::kUint16,
             {kind_.height, kind_.width}}};
  }
  void measure(int, const Pose& X_WS, Values& out) override {
    look(*scene_, pixels_, kind_.far, X_WS,
         [&](std::size_t i, double, const std::optional<BeamHit>& hit) {
           out[0][i] = hit ? label_of(*hit) : 0;
         });
  }
  void finish(Values&, double, Random&) override {}

 private:
  static double label_of(const BeamHit& hit) {
    return hit.what == Met::kGround ? 1 : (hit.what == Met::kSoil ? 2 : 3 + hit.machine);
  }

  scene::DepthCamera kind_;
  std::shared_ptr<RayScene> scene_;
  Pixels pixels_;
};

}  // namespace

std::unique_ptr<Instrument> make(const scene::DepthCamera& kind, const Mounting& at,
                                 Random& random) {
  return std::make_unique<DepthInstrument>(kind, at, random);
}

std::unique_ptr<Instrument> make(const scene::LabelCamera& kind, const Mounting& at, Random&) {
  return std::make_unique<LabelInstrument>(kind, at);
}

}  // namespace navvy::sensor
