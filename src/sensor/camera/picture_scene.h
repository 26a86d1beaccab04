// SPDX-License-Identifier: Apache-2.0
// The world as colour cameras see it: drawn as the pictures of a scene's cameras are.
#pragma once

#include <memory>

#include "core/math.h"
#include "render/image.h"
#include "sim/world.h"

namespace navvy::sensor {

/// Draws pictures of one world for all its colour cameras. The drawing context and the mesh of the
/// ground are made by the first picture and kept; cameras that look in the same step share a frame.
/// All calls must come from one thread.
class PictureScene {
 public:
  /// Prepares to draw `world`, which must outlive this object.
  explicit PictureScene(const sim::World& world);
  ~PictureScene();
  PictureScene(const PictureScene&) = delete;
  PictureScene& operator=(const PictureScene&) = delete;

  /// Returns what a camera at the pose X_WS sees, with x of S ahead and z up. `fov` is the
  /// horizontal field of view [rad].
  /// @throws Error if no drawing context can be made; FileError or InputError for a mesh.
  render::Image draw(const Pose& X_WS, int width, int height, double fov);
  /// Makes the next picture look at the world anew, after another state was loaded into it.
  void forget();

 private:
  struct State;
  const sim::World& world_;
  std::unique_ptr<State> state_;  ///< null before the first picture
};

}  // namespace navvy::sensor
