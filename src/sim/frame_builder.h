// SPDX-License-Identifier: Apache-2.0
// Converts the current state of a world into a frame (all data that a renderer needs for one
// picture), and scene cameras into camera poses.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "heightfield/change_follower.h"
#include "scene/frame.h"
#include "scene/overlay.h"
#include "sim/world.h"

namespace navvy::soil {
struct Particle;
}

namespace navvy::sim {

class CameraFraming;
class ParticleClipper;

/// Builds frames to draw of one world. Keeps the ground data between calls and rewrites only the
/// ground that has changed.
///
/// A frame shows a window of at most 1024 x 1024 ground columns: the whole of a small site,
/// otherwise the area around the machines. The window moves when the machines come within a quarter
/// of its width of its edge.
class FrameBuilder {
 public:
  /// Creates a builder for frames of `world`, which must outlive this object. `show` has names of
  /// overlays as in scene::Scene::show; those that color soil are applied here, the others by the
  /// caller, through `overlay`.
  explicit FrameBuilder(const World& world, const std::string& show = "");
  ~FrameBuilder();
  /// Returns a frame of the world's current state. It is valid until the next call.
  const scene::Frame& build();
  /// Returns the lines and text over the pictures of the frames, which only the caller changes.
  scene::FrameOverlay& overlay() { return frame_.overlay; }
  /// Returns the current pose of a scene camera. A camera that chases a machine follows the
  /// machine's position and heading, but not its pitch and roll. A camera that frames something
  /// moves along its direction until that fills the picture.
  /// @throws InputError if the camera's machine does not exist.
  scene::FrameCamera camera(const scene::Camera& camera);

 private:
  /// Moves the window when the machines approach its edge. After a move, the next frame contains
  /// all of the ground again.
  void place_window();
  /// Copies the ground that has changed since the last frame into the drawn window.
  void update_ground();
  /// Copies the heights with the active soil that rests on the ground.
  void update_loose(const heightfield::TerrainView& columns);
  /// Marks ground columns as changed in the frame.
  void mark_changed(const heightfield::CellRect& rect);
  /// Copies heights and soils of the ground columns in `rect` (column indices of the site) into the
  /// window.
  void copy_ground(const heightfield::Terrain& terrain, const heightfield::CellRect& rect);
  /// Adds all visual shapes of the machines with their poses, and all cylinders.
  void add_machines();
  /// Adds the active particles, moved away from the plates of tools.
  void add_particles();
  /// Returns the position of an active particle on the scale of colors, from 0 to 1. Needs
  /// `color_`.
  double shade_of(const soil::Particle& particle) const;

  const World& world_;
  /// Overlay that colors active soil; without one, soil has its own color.
  std::optional<scene::Overlay> color_;
  /// Frame that `build` fills and returns.
  scene::Frame frame_;
  /// Ground columns that are drawn, as column indices of the site.
  heightfield::CellRect window_;
  /// Keeps track of the ground that has changed since the last frame.
  heightfield::ChangeFollower changes_;
  /// The same for the surface with the active soil that rests on it.
  heightfield::ChangeFollower loose_changes_;
  /// Finds what the scene's cameras frame. Made at the first call of `camera`: sensors never call
  /// it.
  std::unique_ptr<const CameraFraming> framing_;
  /// Moves drawn particles away from the plates of tools.
  std::unique_ptr<ParticleClipper> plates_;
};

}  // namespace navvy::sim
