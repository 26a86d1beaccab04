// SPDX-License-Identifier: Apache-2.0
// Input of renderers and cameras at one instant: shapes with poses, the ground, loose particles. It
// does not refer to a solver; sim fills it, render draws it.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/math.h"
#include "scene/machine.h"
#include "scene/scene.h"

namespace navvy::scene {

/// Pose of a visual. `visual` outlives the frame. V is the frame of the visual, W the world.
struct FrameShape {
  const Visual* visual = nullptr;
  Pose X_WV = Pose::Identity();
};

/// A hydraulic cylinder between its two pins [m] in W: a round barrel from the base, and a thinner
/// rod over the whole length.
struct FrameCylinder {
  Vec3 p_base = Vec3::Zero(), p_rod = Vec3::Zero();
  // Outer radius and length of the barrel [m]; the pins may be closer than its length.
  double radius = 0.06;
  double barrel_length = 0.5;
};

/// Half-open rectangle of columns of a FrameGround.
struct FrameRect {
  int x0 = 0, y0 = 0, x1 = 0, y1 = 0;
};

/// Copy of the ground's surface. Node (ix, iy) is the column centre at origin + ((ix, iy) + 0.5)
/// cell; x runs fastest.
struct FrameGround {
  int nx = 0, ny = 0;
  double cell = 0.1;               ///< [m]
  Vec2 origin = Vec2::Zero();      ///< lower-left corner of column (0,0) in W [m]
  std::vector<float> height;       ///< [m], nx * ny
  std::vector<float> change;       ///< height - height at the start [m]; the dug and dumped parts
  std::vector<std::uint8_t> soil;  ///< index into `soil_color` of the surface layer
  // Linear RGB by the index of a soil, for ground and particles.
  std::vector<Color> soil_color;
  std::uint64_t revision = 0;  ///< changes whenever any height changed
  /// Rectangles that hold all changes since the frame of the last revision; they may overlap.
  std::vector<FrameRect> changed;
};

/// Loose soil, one entry per particle in all arrays. Positions are floats relative to `origin`,
/// which keeps their precision on a large site.
struct FrameParticles {
  std::vector<float> position;  ///< xyz in W [m], relative to `origin`
  Vec3 origin = Vec3::Zero();
  std::vector<std::uint8_t> soil;  ///< index into FrameGround::soil_color
  /// Number for life, by which a particle keeps its appearance; empty: its index.
  std::vector<std::uint32_t> id;
  double radius = 0.04;  ///< [m]
  /// Distance from the closest plate [m], beyond which a drawn particle is clipped; empty: none.
  std::vector<float> clearance;
};

/// Input of one picture. Filling and drawing may happen in different threads.
struct Frame {
  double time = 0;  ///< [s]
  std::vector<FrameShape> shapes;
  std::vector<FrameCylinder> cylinders;
  // Ground and particles are of the same instant as the poses.
  FrameGround ground;
  FrameParticles particles;
  std::vector<Light> lights;
};

/// Camera of one frame: pose with x right, y up, looking along -z (OpenGL).
struct FrameCamera {
  Pose X_WC = Pose::Identity();
  double fov = radians(50);  ///< horizontal [rad]
  int width = 1280, height = 720;
};

}  // namespace navvy::scene
