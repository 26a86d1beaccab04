// SPDX-License-Identifier: Apache-2.0
// Pictures of a running world as the cameras of its scene see it.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "render/image.h"
#include "scene/scene.h"
#include "sim/world.h"

namespace navvy::record {

/// Draws what the cameras of one world see.
///
/// The drawing context is made by the first picture, so a run without pictures needs none. A
/// process may hold one such context at a time (render::Renderer). Draws on the calling thread.
class CameraPictures {
 public:
  /// Receives each picture as soon as it is drawn.
  using Receiver = std::function<void(const scene::Camera& camera, const render::Image& image)>;

  /// Keeps a reference to `world`, which must outlive this object.
  explicit CameraPictures(const sim::World& world);
  ~CameraPictures();
  CameraPictures(const CameraPictures&) = delete;
  CameraPictures& operator=(const CameraPictures&) = delete;

  /// Draws one picture for each of `cameras`, all of the same instant. Filling the frame to draw is
  /// the expensive part and happens once. Does nothing for an empty list. @throws Error when no
  /// drawing context can be made.
  void draw(const std::vector<const scene::Camera*>& cameras, const Receiver& receiver);
  /// Returns what the named camera of the scene sees now.
  /// @throws InputError that names the nearest camera; Error when no drawing context can be made.
  render::Image draw(const std::string& camera);

 private:
  struct Context;  ///< made by the first picture
  const sim::World& world_;
  std::unique_ptr<Context> context_;
};

}  // namespace navvy::record
