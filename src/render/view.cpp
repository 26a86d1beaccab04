// SPDX-License-Identifier: Apache-2.0
#include "render/view.h"

namespace navvy::render {

View::View(const scene::FrameCamera& camera)
    : eye(camera.X_WC.translation().cast<float>()),
      rotation(camera.X_WC.linear()),
      width(camera.width),
      height(camera.height) {
  // Angles of 0 and 180 degrees give no picture.
  const double fov = std::clamp(camera.fov, radians(1), radians(170));
  tan_x = std::tan(0.5 * fov);
  // Pixels are square, so the height follows from the width.
  tan_y = tan_x * height / width;
  pixels_per_radian = static_cast<float>(0.5 * width / tan_x);

  // Standard perspective projection of OpenGL, looking along -z, with depth from -1 to 1.
  Eigen::Matrix4d p = Eigen::Matrix4d::Zero();
  p(0, 0) = 1 / tan_x;
  p(1, 1) = 1 / tan_y;
  p(2, 2) = -(kFar + kNear) / (kFar - kNear);
  p(2, 3) = -2 * kFar * kNear / (kFar - kNear);
  p(3, 2) = -1;
  Eigen::Map<Eigen::Matrix4d>(projection.data()) = p;
  Eigen::Map<Eigen::Matrix4d>(model_view.data()) = camera.X_WC.inverse().matrix();

  // Each side plane contains the camera and an edge of the picture; its normal points inwards.
  const Vec3 right = rotation.col(0), up = rotation.col(1), forward = -rotation.col(2);
  const std::array<Vec3, 5> normals = {
      (forward * tan_x + right).eval(), (forward * tan_x - right).eval(),
      (forward * tan_y + up).eval(), (forward * tan_y - up).eval(), forward};
  for (std::size_t i = 0; i < normals.size(); ++i) {
    const Vec3 n = normals[i].normalized();
    planes[i].head<3>() = n.cast<float>();
    planes[i].w() = static_cast<float>(-n.dot(camera.X_WC.translation()));
  }
}

bool View::sees(const Vec3f& low, const Vec3f& high) const {
  for (const Eigen::Vector4f& plane : planes) {
    // The corner farthest inside decides: a box is culled only when it is wholly beyond one plane.
    float most = plane.w();
    for (int i = 0; i < 3; ++i) most += plane[i] * (plane[i] > 0 ? high[i] : low[i]);
    if (most < 0) return false;
  }
  return true;
}

}  // namespace navvy::render
