// SPDX-License-Identifier: Apache-2.0
#include "sim/camera_framing.h"

#include <gtest/gtest.h>

#include <cmath>

namespace navvy::sim {
namespace {

/// Returns a camera that looks along `forward` with the world's z up in its picture.
scene::FrameCamera looking(const Vec3& forward) {
  scene::FrameCamera camera;
  const Vec3 back = -forward.normalized(), right = Vec3::UnitZ().cross(back).normalized();
  camera.X_WC.linear().col(0) = right;
  camera.X_WC.linear().col(1) = back.cross(right);
  camera.X_WC.linear().col(2) = back;
  return camera;
}

/// Returns the place of a point in the picture: -1 to 1 from left to right and from bottom to top.
Vec2 place(const scene::FrameCamera& camera, const Vec3& p_W) {
  const Vec3 p = camera.X_WC.inverse() * p_W;
  const double tan_x = std::tan(0.5 * camera.fov);
  EXPECT_LT(p.z(), 0) << "behind the camera";
  return {p.x() / -p.z() / tan_x, p.y() / -p.z() / (tan_x * camera.height / camera.width)};
}

TEST(FramePoints, FillsThePictureUpToTheMargin) {
  const std::vector<Vec3> box = {{10, 3, 0}, {18, 3, 0},   {10, 6, 0},   {18, 6, 0},
                                 {10, 3, 4}, {18, 3, 3.5}, {10, 6, 2.5}, {18, 6, 1}};
  for (const Vec3& forward : {Vec3(1, 0.4, -0.5), Vec3(-1, 2, -0.1), Vec3(0.01, 0, -1)}) {
    for (const double fov : {20.0, 50.0, 110.0}) {
      scene::FrameCamera camera = looking(forward);
      camera.fov = radians(fov);
      const Mat3 before = camera.X_WC.linear();
      frame_points(box, camera);
      EXPECT_EQ(camera.X_WC.linear(), before);
      Vec2 low = Vec2::Constant(9), high = -low;
      for (const Vec3& p : box) {
        low = low.cwiseMin(place(camera, p));
        high = high.cwiseMax(place(camera, p));
      }
      // Nothing is beyond the margins, and the side that decides touches both.
      EXPECT_NEAR(high.maxCoeff(), 0.9, 1e-9);
      EXPECT_NEAR(low.minCoeff(), -0.9, 1e-9);
    }
  }
}

TEST(FramePoints, LeavesTheCameraWhereThereIsNothingToFrame) {
  scene::FrameCamera camera = looking({1, 0, -1});
  camera.X_WC.translation() = Vec3(1, 2, 3);
  frame_points({}, camera);
  EXPECT_EQ(camera.X_WC.translation(), Vec3(1, 2, 3));
}

}  // namespace
}  // namespace navvy::sim
