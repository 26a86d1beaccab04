// SPDX-License-Identifier: Apache-2.0
// Draws pictures of a running world as the cameras of its scene see it.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "render/image.h"
#include "scene/scene.h"
#include "session/session.h"

namespace navvy::record {

/// Draws pictures from the cameras of one session.
///
/// The first picture creates the drawing context, so a run without pictures needs none. Pictures
/// are drawn on the calling thread.
class CameraPictures {
 public:
  /// Function that receives each picture as soon as it is drawn, with the camera's pose X_WC.
  using Receiver =
      std::function<void(const scene::Camera& camera, const Pose& X_WC, render::Image image)>;

  /// Creates an object that draws the world of `session`, which must outlive it, with the overlays
  /// of its scene. Draws nothing yet.
  explicit CameraPictures(const session::Session& session);
  ~CameraPictures();
  CameraPictures(const CameraPictures&) = delete;
  CameraPictures& operator=(const CameraPictures&) = delete;

  /// Draws one picture of the world's current state for each camera in `cameras` and passes it to
  /// `receiver`. All pictures share one frame, because preparing the frame takes most of the time.
  /// Does nothing if `cameras` is empty.
  /// @throws Error if no drawing context can be created.
  void draw(const std::vector<const scene::Camera*>& cameras, const Receiver& receiver);
  /// Returns a picture of the world's current state from the scene camera called `camera`.
  /// @throws InputError if there is no such camera; the message names the most similar one. Error
  /// if no drawing context can be created.
  render::Image draw(const std::string& camera);

 private:
  /// Drawing context and frame builder; created by the first picture.
  struct Context;
  const session::Session& session_;
  std::unique_ptr<Context> context_;
};

}  // namespace navvy::record
