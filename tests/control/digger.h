// SPDX-License-Identifier: Apache-2.0
// An excavator without masses, of the shipped machine's proportions, for tests of the operator.
#pragma once

#include <string>
#include <vector>

#include "core/math.h"
#include "scene/machine.h"

namespace navvy::control {

/// Chassis at the rear axle's ground point, swing axis 1.25 m ahead, boom 5.10 m, stick 2.45 m, bucket 1.40 m.
inline scene::Machine make_digger() {
  scene::Machine machine;
  machine.name = "digger";
  machine.kinematic = true;
  const auto link = [&](const std::string& name, const Vec3& p_M) {
    scene::Link l;
    l.name = name;
    l.X_ML.translation() = p_M;
    machine.links.push_back(l);
    return static_cast<int>(machine.links.size()) - 1;
  };
  const int chassis = link("chassis", {0, 0, 0});
  const int upper = link("upper", {1.25, 0, 1.18});
  const int boom = link("boom", {1.50, 0, 1.98});
  const int stick = link("stick", {6.60, 0, 1.98});
  const int bucket = link("bucket", {9.05, 0, 1.98});
  const auto joint = [&](const std::string& name, int parent, int child, const Vec3& axis, double lower, double upper_q,
                         double initial) {
    scene::Joint j;
    j.name = name;
    j.type = scene::Joint::Type::kRevolute;
    j.parent = parent;
    j.child = child;
    j.axis = axis;
    j.has_limits = lower < upper_q;
    j.lower = lower;
    j.upper = upper_q;
    j.initial = initial;
    machine.joints.push_back(j);
  };
  const Vec3 up(0, -1, 0);
  joint("swing_joint", chassis, upper, Vec3::UnitZ(), 0, 0, 0);
  joint("boom_joint", upper, boom, up, -0.85, 1.05, 0.6);
  joint("arm_joint", boom, stick, up, -2.75, -0.60, -1.9);
  joint("bucket_joint", stick, bucket, up, -2.60, 0.40, -1.6);
  machine.swing_joint = "swing_joint";
  machine.boom_joint = "boom_joint";
  machine.stick_joint = "arm_joint";
  machine.bucket_joint = "bucket_joint";
  scene::Bucket data;
  data.link = "bucket";
  data.p_tip = Vec3(1.40, 0, 0);
  data.cut_direction = Vec3(std::cos(radians(-50)), 0, std::sin(radians(-50)));
  machine.buckets.push_back(data);
  return machine;
}

}  // namespace navvy::control
