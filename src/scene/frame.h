// SPDX-License-Identifier: Apache-2.0
// A Frame is everything a renderer or sensor needs of one instant: shapes with poses, the ground,
// loose particles. It refers to no solver; sim fills it, render draws it.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/math.h"
#include "scene/machine.h"
#include "scene/scene.h"

namespace navvy::scene {

/// A visual placed in the world. `visual` outlives the frame. V is the visual's own frame, W the
/// world.
struct FrameShape {
  const Visual* visual = nullptr;
  Pose X_WV = Pose::Identity();
};

/// A hydraulic cylinder to draw between its two pins [m] in W. Both are drawn round: the barrel
/// from the base, the rod, thinner, over the whole length.
struct FrameCylinder {
  Vec3 p_base = Vec3::Zero(), p_rod = Vec3::Zero();
  // Half the barrel's outer width [m], and the length of the barrel [m]; the pins may come nearer
  // than that.
  double radius = 0.06;
  double barrel_length = 0.5;
};

/// Half-open rectangle of columns of a FrameGround.
struct FrameRect {
  int x0 = 0, y0 = 0, x1 = 0, y1 = 0;
};

/// Dense copy of the ground's surface. Node (ix, iy) is the column centre at origin + ((ix, iy) +
/// 0.5) cell; x fastest. It is a copy, so that drawing asks nothing of the simulation.
struct FrameGround {
  int nx = 0, ny = 0;
  double cell = 0.1;               ///< [m]
  Vec2 origin = Vec2::Zero();      ///< lower-left corner of column (0,0) in W [m]
  std::vector<float> height;       ///< [m], nx * ny
  std::vector<float> change;       ///< height - height at the start [m]; the dug and dumped parts
  std::vector<std::uint8_t> soil;  ///< index into `soil_color` of the surface layer
  // Linear RGB by soil number, for ground and particles alike.
  std::vector<Color> soil_color;
  std::uint64_t revision = 0;  ///< changes whenever any height changed
  std::vector<FrameRect>
      changed;  ///< hold all that changed since the frame of the last revision; may overlap
};

/// Loose soil: one entry a particle, all arrays in one order. Positions are floats about `origin`,
/// so that a site of kilometres costs no digits.
struct FrameParticles {
  std::vector<float> position;  ///< xyz in W [m], relative to `origin`
  Vec3 origin = Vec3::Zero();
  std::vector<std::uint8_t> soil;  ///< index into FrameGround::soil_color
  std::vector<std::uint32_t>
      id;  ///< unique for life, so that a lump keeps its looks; empty: the place in the list
  double radius = 0.04;  ///< [m]
  std::vector<float>
      room;  ///< to the closest plate [m], so that no lump sticks out through it; empty: no plates
};

/// All that a renderer needs of one instant. Filled anew for each picture; filling and drawing need
/// not happen in one thread.
struct Frame {
  double time = 0;  ///< [s]
  std::vector<FrameShape> shapes;
  std::vector<FrameCylinder> cylinders;
  // Of the same instant as the poses, so that soil lies in the bucket and not beside it.
  FrameGround ground;
  FrameParticles particles;
  std::vector<Light> lights;
};

/// A camera resolved for one frame: pose with x right, y up, looking along -z (OpenGL).
struct FrameCamera {
  Pose X_WC = Pose::Identity();
  double fov = radians(50);  ///< horizontal [rad]
  int width = 1280, height = 720;
};

}  // namespace navvy::scene
