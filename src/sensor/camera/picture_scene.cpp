// SPDX-License-Identifier: Apache-2.0
#include "sensor/camera/picture_scene.h"

#include <string>

#include "core/error.h"
#ifndef NAVVY_SLIM
#include "render/renderer.h"
#endif
#include "sim/frame_builder.h"

namespace navvy::sensor {

#ifdef NAVVY_SLIM

// A slim build has no module render.
struct PictureScene::State {};

PictureScene::PictureScene(const sim::World& world) : world_(world) {}
PictureScene::~PictureScene() = default;

void PictureScene::forget() {}

render::Image PictureScene::draw(const Pose&, int, int, double) {
  throw Error("this build of Navvy draws no pictures, so its colour cameras see nothing: install " +
              std::string("the full program, or take the camera out of the scene '") +
              world_.description().file + "'");
}

#else

struct PictureScene::State {
  explicit State(const sim::World& world) : frames(world) {}
  sim::FrameBuilder frames;
  render::Renderer renderer;
  const scene::Frame* frame = nullptr;  ///< the frame of step `steps`; null: none
  std::uint64_t steps = 0;
};

PictureScene::PictureScene(const sim::World& world) : world_(world) {}
PictureScene::~PictureScene() = default;

void PictureScene::forget() {
  if (state_) state_->frame = nullptr;
}

render::Image PictureScene::draw(const Pose& X_WS, int width, int height, double fov) {
  if (!state_) state_ = std::make_unique<State>(world_);
  State& s = *state_;
  if (s.frame == nullptr || s.steps != world_.steps()) {
    s.frame = &s.frames.build();
    s.steps = world_.steps();
  }
  scene::FrameCamera camera;
  // Axes of the camera C in S: right, up, back.
  Mat3 R_SC;
  R_SC << 0, 0, -1, -1, 0, 0, 0, 1, 0;
  camera.X_WC = X_WS;
  camera.X_WC.linear() = X_WS.linear() * R_SC;
  camera.fov = fov;
  camera.width = width;
  camera.height = height;
  return s.renderer.render(*s.frame, camera);
}

#endif

}  // namespace navvy::sensor
