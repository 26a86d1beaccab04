// SPDX-License-Identifier: Apache-2.0
// Converts the state of a world into a Frame to draw, and scene cameras into poses.
#pragma once

#include <memory>

#include "heightfield/change_follower.h"
#include "scene/frame.h"
#include "sim/world.h"

namespace navvy::sim {

class ParticleClipper;

/// Fills frames of one world. Keeps the dense ground between calls and rewrites only what changed.
///
/// The ground window holds at most 1024 x 1024 columns: the whole of a small site, otherwise the
/// part around the machines, which moves when a machine comes within a quarter of its edge.
class FrameBuilder {
 public:
  /// Reads the constants of a world, which must outlive this object.
  explicit FrameBuilder(const World& world);
  ~FrameBuilder();
  /// Returns the present frame, valid until the next call.
  const scene::Frame& build();
  /// Returns the present pose of a scene camera. A chasing camera follows the heading only.
  scene::FrameCamera camera(const scene::Camera& camera) const;

 private:
  /// Moves the window where machines approach its edge. The next ground is then complete.
  void place_window();
  /// Copies the changes since the last frame into the window.
  void update_ground();
  /// Copies the columns of one rectangle, relative to the window.
  void copy_ground(const heightfield::Terrain& terrain, const heightfield::CellRect& rect);
  /// Adds the poses of all visuals and cylinders.
  void add_machines();
  /// Returns a cylinder of machine m, with the bars of its bucket linkage.
  void add_cylinder(int m, const scene::Cylinder& cylinder);
  /// Adds the active particles, kept off the plates of tools.
  void add_particles();

  const World& world_;
  scene::Frame frame_;
  // Columns of the site that are drawn, and the changes among them.
  heightfield::CellRect window_;
  heightfield::ChangeFollower changes_;
  std::unique_ptr<ParticleClipper> plates_;
};

}  // namespace navvy::sim
