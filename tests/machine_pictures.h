// SPDX-License-Identifier: Apache-2.0
// Share of the pictures of a scene's cameras that its machines take, by projection.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "sim/camera_framing.h"
#include "sim/frame_builder.h"
#include "sim/occupied_areas.h"

namespace navvy::test {

/// Projects the boxes around all shapes of the machines of a world, which must outlive this object,
/// into its cameras.
class MachinePictures {
 public:
  explicit MachinePictures(const sim::World& world) : world_(world), frames_(world) {
    for (const scene::MachineInWorld& placed : world.description().machines)
      boxes_.push_back(sim::shape_boxes(placed.machine));
  }

  /// Returns the largest share of a picture's width that a machine takes, over all cameras that are
  /// fixed or follow a machine; 0 if a part of it is outside of each picture.
  double largest_share(std::size_t machine) {
    double most = 0;
    for (const scene::Camera& camera : world_.description().cameras)
      if (camera.kind != scene::Camera::Kind::kOnLink)
        most = std::max(most, share_of_width(machine, frames_.camera(camera)));
    return most;
  }
  /// Expects that each machine takes more than this share of a picture's width.
  void expect_shown(double share) {
    const scene::Scene& scene = world_.description();
    for (std::size_t m = 0; m < scene.machines.size(); ++m)
      if (sim::is_machine(scene.machines[m])) {
        EXPECT_GT(largest_share(m), share)
            << scene.name << " at " << world_.time() << " s: " << scene.machines[m].name;
      }
  }

 private:
  double share_of_width(std::size_t machine, const scene::FrameCamera& camera) const {
    const sim::MachineHandle handle = world_.machines().at(static_cast<int>(machine));
    double left = 2, right = -2;
    for (const sim::ShapeBox& part : boxes_[machine])
      for (const Vec3& corner : geometry::corners(part.box)) {
        const Vec3 p = camera.X_WC.inverse() * (handle.link(part.link).pose() * corner);
        const double tan_x = std::tan(0.5 * camera.fov);
        const double x = p.x() / -p.z() / tan_x,
                     y = p.y() / -p.z() / (tan_x * camera.height / camera.width);
        if (p.z() >= 0 || std::abs(x) > 1 || std::abs(y) > 1) return 0;
        left = std::min(left, x);
        right = std::max(right, x);
      }
    return std::max(0.0, 0.5 * (right - left));
  }

  const sim::World& world_;
  sim::FrameBuilder frames_;
  std::vector<std::vector<sim::ShapeBox>> boxes_;
};

}  // namespace navvy::test
