// SPDX-License-Identifier: Apache-2.0
// Turns the state of a world into a Frame to draw, and scene cameras into poses.
#pragma once

#include <memory>

#include "heightfield/change_follower.h"
#include "scene/frame.h"
#include "sim/world.h"

namespace navvy::sim {

class ParticleClipper;

/// Fills frames of one world; keeps the dense ground between calls and rewrites only what changed.
///
/// The ground window holds at most 1024 x 1024 columns: the whole of a small site, else the part
/// around the machines, moved when one comes within a quarter of its edge.
class FrameBuilder {
 public:
  explicit FrameBuilder(const World& world);
  ~FrameBuilder();
  /// The frame of this instant; valid until the next call.
  const scene::Frame& build();
  /// Pose of a scene camera now; a chasing camera follows heading only.
  scene::FrameCamera camera(const scene::Camera& camera) const;

 private:
  /// Moves the window where machines near its edge; the next ground is then a whole one.
  void place_window();
  /// Copies what changed since the last frame into the window.
  void update_ground();
  void copy_ground(const heightfield::Terrain& terrain, const heightfield::CellRect& rect);
  void add_machines();
  /// A cylinder of machine m, with the bars of its bucket linkage.
  void add_cylinder(int m, const scene::Cylinder& cylinder);
  void add_particles();

  const World& world_;
  scene::Frame frame_;
  // Columns of the site that are drawn, and what changed among them.
  heightfield::CellRect window_;
  heightfield::ChangeFollower changes_;
  std::unique_ptr<ParticleClipper> plates_;
};

}  // namespace navvy::sim
