// SPDX-License-Identifier: Apache-2.0
#include "coupling/machine_placing.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "vehicle/kinematics.h"

namespace navvy::coupling {
namespace {

/// Returns the points of the wheels on the machine's own ground plane, its x and y axes, with the
/// machine at X_WM [m].
std::vector<Vec3> contacts(const scene::Machine& machine, const Pose& X_WM) {
  std::vector<double> q;
  for (const scene::Joint& joint : machine.joints) q.push_back(joint.initial);
  const std::vector<Pose> X_WL = vehicle::forward_kinematics(machine, base_pose(machine, X_WM), q);
  const Vec3 up = X_WM.linear().col(2);
  std::vector<Vec3> out;
  for (const scene::Wheel& wheel : machine.wheels) {
    const int joint = machine.joint_index(wheel.joint);
    if (joint < 0) continue;
    if (wheel.track) {
      const int carrier = machine.joints[static_cast<std::size_t>(joint)].parent;
      for (const Vec3& p : wheel.track->lower_run())
        out.push_back(X_WL[static_cast<std::size_t>(carrier)] * p);
      continue;
    }
    const int link = machine.joints[static_cast<std::size_t>(joint)].child;
    out.push_back(X_WL[static_cast<std::size_t>(link)].translation() - wheel.radius * up);
  }
  return out;
}

}  // namespace

Pose base_pose(const scene::Machine& machine, const Pose& X_WM) {
  return machine.links.empty() ? X_WM : X_WM * machine.links[0].X_ML;
}

// Fits a plane to the ground under the wheels, tilts the machine with it, and raises it.
Pose place(const scene::MachineInWorld& placed, const heightfield::Ground& ground) {
  Pose X_WM = placed.X_WM;
  if (!placed.on_ground) return X_WM;
  // Start level, on the ground below its origin, rotated about the vertical only.
  const Vec3 origin(X_WM.translation().x(), X_WM.translation().y(),
                    ground.sample(X_WM.translation().x(), X_WM.translation().y()));
  const Vec3 ahead = X_WM.linear().col(0);
  Pose standing =
      make_pose(origin.x(), origin.y(), origin.z(), 0, 0, std::atan2(ahead.y(), ahead.x()));
  X_WM.translation().z() += origin.z();
  const std::vector<Vec3> support_points = contacts(placed.machine, standing);
  if (support_points.size() < 3) return X_WM;
  // Fit the plane h = a + b x + c y to the ground's height above the support points, x and y from
  // the origin.
  Mat3 normal_matrix = Mat3::Zero();
  Vec3 right = Vec3::Zero();
  double highest = 0;
  for (const Vec3& point : support_points) {
    const Vec3 row(1, point.x() - origin.x(), point.y() - origin.y());
    const double step = ground.sample(point.x(), point.y()) - point.z();
    normal_matrix += row * row.transpose();
    right += step * row;
    highest = std::max(highest, std::abs(step));
  }
  if (highest < 1e-9 || std::abs(normal_matrix.determinant()) < 1e-9) return X_WM;
  const Vec3 plane = normal_matrix.ldlt().solve(right);
  const Vec3 up = Vec3(-plane.y(), -plane.z(), 1).normalized();
  const Mat3 tilt = Eigen::Quaterniond::FromTwoVectors(Vec3::UnitZ(), up).toRotationMatrix();
  standing.linear() = tilt * standing.linear();
  double raise = -std::numeric_limits<double>::infinity();
  for (const Vec3& point : contacts(placed.machine, standing))
    raise = std::max(raise, ground.sample(point.x(), point.y()) - point.z());
  // Add the height over the ground, roll and pitch of the scene.
  X_WM.linear() = tilt * X_WM.linear();
  X_WM.translation().z() += raise;
  return X_WM;
}

}  // namespace navvy::coupling
