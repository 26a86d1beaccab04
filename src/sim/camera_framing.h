// SPDX-License-Identifier: Apache-2.0
// Places cameras so that machines, or the places of their programs, fill the pictures.
#pragma once

#include <utility>
#include <vector>

#include "geometry/oriented_box.h"
#include "scene/frame.h"
#include "sim/world.h"

namespace navvy::sim {

/// The box around a shape of a machine, in the frame of a link.
struct ShapeBox {
  int link = 0;               ///< index of the link
  geometry::OrientedBox box;  ///< box in the frame of the link [m]
};
/// Returns the boxes of all visuals, collision shapes and wheels of a machine. Reads its meshes.
std::vector<ShapeBox> shape_boxes(const scene::Machine& machine);

/// Finds what fills the pictures of a scene's cameras.
///
/// The construction reads the meshes of all machines, if a camera of the scene frames anything;
/// `points` then costs microseconds.
class CameraFraming {
 public:
  /// Prepares the cameras of the scene of `world`, which must outlive this object.
  explicit CameraFraming(const World& world);
  /// Returns points in W [m] around what fills the pictures of `camera`: the machine that it
  /// follows or, without one, all machines at present for Framed::kMachine; the places of all
  /// programs and all machines at their start for kProgram; also all other bodies for kAll. The
  /// points for the last two do not change. Empty for kNothing, and if the scene has none of these.
  std::vector<Vec3> points(const scene::Camera& camera) const;

 private:
  /// Adds the machines at their start, other bodies if `bodies`, and the places of all programs.
  void add_start(bool bodies, std::vector<Vec3>& out) const;

  const World& world_;
  /// Boxes of each machine of the scene.
  std::vector<std::vector<ShapeBox>> parts_;
  /// Points that do not change: of programs, and of everything.
  std::vector<Vec3> program_, all_;
};

/// Moves `camera`, without turning it, to the nearest place from which its picture shows all
/// `points` [m] within a margin of a twentieth of the picture on each side. Does nothing without
/// points.
void frame_points(const std::vector<Vec3>& points, scene::FrameCamera& camera);

}  // namespace navvy::sim
