// SPDX-License-Identifier: Apache-2.0
// Colour cameras, single and in pairs.
#include <algorithm>
#include <cmath>

#include "sensor/camera/picture_scene.h"
#include "sensor/instrument.h"

namespace navvy::sensor {
namespace {

/// One camera, or several side by side that differ in their places along y of S.
class ColourInstrument final : public Instrument {
 public:
  /// Creates cameras with these names at these places along y of S [m].
  ColourInstrument(const scene::ColourCamera& kind, const Mounting& at, Random& random,
                   std::vector<const char*> names, std::vector<double> places)
      : kind_(kind),
        pictures_(at.pictures),
        noise_(kind.noise, random),
        names_(std::move(names)),
        places_(std::move(places)) {}

  std::vector<MeasuredQuantity> quantities() const override {
    std::vector<MeasuredQuantity> out;
    for (const char* name : names_)
      out.push_back({name,
                     "1",
                     "red, green and blue of each pixel, sRGB",
                     sim::ElementType::kUint8,
                     {kind_.height, kind_.width, 3}});
    return out;
  }
  void measure(int, const Pose& X_WS, Values& out) override {
    for (std::size_t i = 0; i < places_.size(); ++i) {
      const Pose X_WC = X_WS * make_pose(0, places_[i], 0, 0, 0, 0);
      const render::Image image = pictures_->draw(X_WC, kind_.width, kind_.height, kind_.fov);
      out[i].assign(image.rgb.begin(), image.rgb.end());
    }
  }
  void finish(Values& out, double dt, Random& random) override {
    if (!kind_.noise.active()) return;
    noise_.advance(dt, random);
    for (std::vector<double>& picture : out)
      for (double& colour : picture)
        colour = std::round(255 * std::clamp(noise_.apply(colour / 255, random), 0.0, 1.0));
  }
  void visit(Archive& a) override { a("noise", noise_); }

 private:
  scene::ColourCamera kind_;
  std::shared_ptr<PictureScene> pictures_;
  Noise noise_;
  std::vector<const char*> names_;
  std::vector<double> places_;
};

}  // namespace

std::unique_ptr<Instrument> make(const scene::ColourCamera& kind, const Mounting& at,
                                 Random& random) {
  return std::make_unique<ColourInstrument>(kind, at, random, std::vector<const char*>{"image"},
                                            std::vector<double>{0});
}

std::unique_ptr<Instrument> make(const scene::StereoCamera& kind, const Mounting& at,
                                 Random& random) {
  return std::make_unique<ColourInstrument>(kind, at, random,
                                            std::vector<const char*>{"left", "right"},
                                            std::vector<double>{0, -kind.baseline});
}

}  // namespace navvy::sensor
