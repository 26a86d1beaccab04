// SPDX-License-Identifier: Apache-2.0
// A camera as numbers: its pose, its field of view, and the size of a metre in its picture.
#pragma once

#include <array>

#include "render/shading.h"
#include "scene/frame.h"

namespace navvy::render {

/// Perspective view of one FrameCamera with square pixels. Built for one picture; everything that
/// depends on the camera alone is computed here, once.
struct View {
  /// Clipping distances [m]. They share the depth buffer's precision, so the near one is as large
  /// as a close view permits.
  static constexpr double kNear = 0.12, kFar = 1500;

  /// Computes the view of a camera.
  explicit View(const scene::FrameCamera& camera);

  /// Returns false only when a box cannot be visible. Tests five planes: the four sides and the
  /// eye's; boxes beyond the far distance count as visible.
  bool sees(const Vec3f& low, const Vec3f& high) const;

  // Position in W [m].
  Vec3f eye;
  /// Axes of the camera in W: right, up, back.
  Mat3 rotation;
  /// Resolution at the picture's centre.
  float pixels_per_radian;
  /// Half the picture's size at distance 1.
  double tan_x, tan_y;
  int width, height;
  /// Column-major matrices for OpenGL.
  std::array<double, 16> projection, model_view;
  /// Planes of four sides and of the eye; positive inside.
  std::array<Eigen::Vector4f, 5> planes;
};

}  // namespace navvy::render
