// SPDX-License-Identifier: Apache-2.0
// A camera as numbers: where it stands, what it can see, how large a metre is in its picture.
#pragma once

#include <array>

#include "render/shading.h"
#include "scene/frame.h"

namespace navvy::render {

/// Perspective view of one FrameCamera with square pixels. Made from a camera for one picture;
/// everything that depends on the camera alone is worked out here, once.
struct View {
  // The depth buffer's digits are shared out between the two, so the nearer one is as far as a
  // close look allows.
  static constexpr double kNear = 0.12, kFar = 1500;  ///< clipping distances [m]

  explicit View(const scene::FrameCamera& camera);

  /// True when the box may be visible (never false for a visible one). Five planes are asked: the
  /// four sides and the eye's; what lies beyond the far distance counts as seen.
  bool sees(const Vec3f& low, const Vec3f& high) const;

  // In W [m].
  Vec3f eye;
  Mat3 rotation;            ///< axes of the camera in W: right, up, back
  float pixels_per_radian;  ///< at the picture's centre
  double tan_x, tan_y;      ///< half the picture at distance 1
  int width, height;
  std::array<double, 16> projection, model_view;  ///< column-major, as OpenGL wants
  std::array<Eigen::Vector4f, 5> planes;          ///< inside is positive: four sides and behind
};

}  // namespace navvy::render
