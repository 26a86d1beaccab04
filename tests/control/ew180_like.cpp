// SPDX-License-Identifier: Apache-2.0
#include "control/ew180_like.h"

namespace navvy::control::testing {
namespace {

scene::Joint pitch(const char* name, int parent, double lower, double upper, double speed,
                   double initial) {
  scene::Joint joint;
  joint.name = name;
  joint.type = scene::Joint::Type::kRevolute;
  joint.parent = parent;
  joint.child = parent + 1;
  joint.axis = -Vec3::UnitY();
  joint.has_limits = true;
  joint.lower = lower;
  joint.upper = upper;
  joint.velocity = speed;
  joint.initial = initial;
  return joint;
}

scene::Shell bucket_shell() {
  // Profile from the tip over the heel to the top, as in the shipped model; its sides do not matter
  // here.
  const double profile[9][2] = {{1.4, 0},      {1.2, 0.235}, {1, 0.43},
                                {0.79, 0.565}, {0.57, 0.63}, {0.36, 0.61},
                                {0.19, 0.5},   {0.1, 0.32},  {0.08, 0.1}};
  scene::Shell shell;
  shell.name = "bucket";
  shell.link = "bucket";
  for (const double y : {0.525, -0.525})
    for (const auto& p : profile) shell.vertices.push_back(Vec3(p[0], y, p[1]));
  for (int i = 0; i < 8; ++i) {
    shell.triangles.push_back({i, i + 10, i + 1});
    shell.triangles.push_back({i, i + 9, i + 10});
  }
  return shell;
}

}  // namespace

scene::Machine ew180_like() {
  scene::Machine machine;
  machine.name = "ew180_like";
  const char* const names[] = {"chassis", "upper", "boom", "stick", "bucket"};
  const double x[] = {0, 1.25, 1.50, 6.60, 9.05}, z[] = {0, 1.18, 1.98, 1.98, 1.98};
  for (int i = 0; i < 5; ++i) {
    scene::Link link;
    link.name = names[i];
    link.X_ML = make_pose(x[i], 0, z[i]);
    machine.links.push_back(link);
  }
  scene::Joint swing;
  swing.name = "swing_joint";
  swing.type = scene::Joint::Type::kRevolute;
  swing.parent = 0;
  swing.child = 1;
  swing.velocity = 0.9425;
  machine.joints = {swing, pitch("boom_joint", 1, -0.85, 1.05, 0.45, radians(43)),
                    pitch("arm_joint", 2, -2.75, -0.6, 0.75, radians(-126)),
                    pitch("bucket_joint", 3, -2.6, 0.4, 1.2, radians(-75))};
  machine.arm.swing = "swing_joint";
  machine.arm.boom = "boom_joint";
  machine.arm.stick = "arm_joint";
  machine.arm.bucket = "bucket_joint";
  machine.shells = {bucket_shell()};
  scene::Bucket bucket;
  bucket.link = "bucket";
  bucket.shell = "bucket";
  bucket.p_tip = Vec3(1.4, 0, 0);
  bucket.cut_direction = Vec3(0.648119, 0, -0.761539);
  bucket.opening = -Vec3::UnitZ();
  machine.buckets = {bucket};
  machine.has_drive = true;
  return machine;
}

}  // namespace navvy::control::testing
