// SPDX-License-Identifier: Apache-2.0
// Projection of a camera: its pose, its field of view, and the size of a metre in its picture.
#pragma once

#include <array>

#include "render/shading.h"
#include "scene/frame.h"

namespace navvy::render {

/// Perspective view of a camera with square pixels. It is built once per picture and holds
/// everything that depends only on the camera.
struct View {
  /// Near and far clipping distances [m]. The near distance is as large as close-up views permit,
  /// because a smaller one would reduce the precision of the depth buffer.
  static constexpr double kNear = 0.12, kFar = 1500;

  /// Computes all members for a camera.
  explicit View(const scene::FrameCamera& camera);

  /// Returns false if the box from `low` to `high` in W [m] cannot be visible. May return true for
  /// a box that is not visible, for example beyond the far clipping distance.
  bool sees(const Vec3f& low, const Vec3f& high) const;

  /// Position of the camera in W [m].
  Vec3f eye;
  /// Axes of the camera in W, as columns: right, up, back.
  Mat3 rotation;
  /// Number of pixels per radian at the centre of the picture.
  float pixels_per_radian;
  /// Tangents of half the horizontal and half the vertical field of view.
  double tan_x, tan_y;
  /// Size of the picture [pixels].
  int width, height;
  /// Projection matrix and model-view matrix for OpenGL, in column-major order.
  std::array<double, 16> projection, model_view;
  /// Planes that bound the visible volume: left, right, bottom and top side and the camera's own
  /// plane, as (normal, offset) in W. The signed distance of a point is positive inside.
  std::array<Eigen::Vector4f, 5> planes;
};

}  // namespace navvy::render
