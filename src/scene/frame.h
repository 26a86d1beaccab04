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

/// A visual with its pose. `visual` must outlive the frame. X_WV takes the visual's frame V to the
/// world W.
struct FrameShape {
  const Visual* visual = nullptr;
  Pose X_WV = Pose::Identity();
};

/// A hydraulic cylinder between two pins in W [m]: a round barrel that begins at the base pin, and
/// a thinner rod from pin to pin.
struct FrameCylinder {
  Vec3 p_base = Vec3::Zero(), p_rod = Vec3::Zero();
  /// Outer radius of the barrel [m].
  double radius = 0.06;
  /// Length of the barrel [m]; the pins may be closer to each other.
  double barrel_length = 0.5;
};

/// Half-open rectangle of columns of a FrameGround: x0 <= x < x1, y0 <= y < y1.
struct FrameRect {
  int x0 = 0, y0 = 0, x1 = 0, y1 = 0;
};

/// Copy of the ground surface: one height per column. Column (ix, iy) has its centre at origin +
/// ((ix, iy) + 0.5) x cell and the index ix + nx x iy.
struct FrameGround {
  int nx = 0, ny = 0;
  /// Edge of a column [m].
  double cell = 0.1;
  /// Lower-left corner of column (0, 0) in W [m].
  Vec2 origin = Vec2::Zero();
  /// Height of each column [m].
  std::vector<float> height;
  /// Height minus height at the start, for each column [m].
  std::vector<float> change;
  /// Soil of each column's surface layer, as an index into `soil_color`.
  std::vector<std::uint8_t> soil;
  // Linear RGB by the index of a soil, for ground and particles.
  std::vector<Color> soil_color;
  /// Changes whenever a height has changed.
  std::uint64_t revision = 0;
  /// Rectangles that hold all changes since the frame of the last revision; they may overlap.
  std::vector<FrameRect> changed;
};

/// Loose soil, one entry per particle in each array. Positions are relative to `origin`, so that
/// floats are precise enough on a large site.
struct FrameParticles {
  /// Positions x y z relative to `origin`, in W [m].
  std::vector<float> position;
  Vec3 origin = Vec3::Zero();
  /// Soil of each particle, as an index into FrameGround::soil_color.
  std::vector<std::uint8_t> soil;
  /// Permanent particle IDs, from which the renderer derives the particles' appearance. If empty,
  /// the index is used.
  std::vector<std::uint32_t> id;
  /// Radius of a particle [m].
  double radius = 0.04;
  /// Distance from the closest plate [m], beyond which a drawn particle is clipped; empty: none.
  std::vector<float> clearance;
};

/// Everything that is needed to draw one picture. Filling and drawing may happen in different
/// threads.
struct Frame {
  /// Simulated time [s].
  double time = 0;
  std::vector<FrameShape> shapes;
  std::vector<FrameCylinder> cylinders;
  // Ground and particles are of the same instant as the poses.
  FrameGround ground;
  FrameParticles particles;
  std::vector<Light> lights;
};

/// A camera for one picture. X_WC takes the camera frame C to W; x points right, y up, and the
/// camera looks along -z (as in OpenGL).
struct FrameCamera {
  Pose X_WC = Pose::Identity();
  double fov = radians(50);  ///< horizontal [rad]
  int width = 1280, height = 720;
};

}  // namespace navvy::scene
