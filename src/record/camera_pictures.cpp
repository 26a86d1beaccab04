// SPDX-License-Identifier: Apache-2.0
#include "record/camera_pictures.h"

#include <utility>

#include "core/edit_distance.h"
#include "core/error.h"
#include "record/overlay_builder.h"
#include "render/renderer.h"
#include "sim/frame_builder.h"

namespace navvy::record {

// The frame builder keeps the dense ground between pictures, the renderer its drawing context.
struct CameraPictures::Context {
  explicit Context(const session::Session& session)
      : frames(session.world(), session.world().description().show), overlays(session) {}
  sim::FrameBuilder frames;
  OverlayBuilder overlays;
  render::Renderer renderer;
};

CameraPictures::CameraPictures(const session::Session& session) : session_(session) {}
CameraPictures::~CameraPictures() = default;

void CameraPictures::draw(const std::vector<const scene::Camera*>& cameras,
                          const Receiver& receiver) {
  if (cameras.empty()) return;
  if (!context_) context_ = std::make_unique<Context>(session_);
  context_->overlays.build(context_->frames.overlay());
  const scene::Frame& frame = context_->frames.build();
  for (const scene::Camera* camera : cameras) {
    const scene::FrameCamera placed = context_->frames.camera(*camera);
    receiver(*camera, placed.X_WC, context_->renderer.render(frame, placed));
  }
}

render::Image CameraPictures::draw(const std::string& camera) {
  render::Image out;
  std::vector<std::string> names;
  for (const scene::Camera& one : session_.world().description().cameras) {
    names.push_back(one.name);
    if (one.name != camera) continue;
    draw({&one},
         [&](const scene::Camera&, const Pose&, render::Image image) { out = std::move(image); });
    return out;
  }
  throw InputError(Fault{Fault::Severity::kError, "", 0, "camera", camera,
                         "the scene has no camera of this name",
                         names.empty() ? "add a <navvy:camera>" : suggestion(camera, names)});
}

}  // namespace navvy::record
