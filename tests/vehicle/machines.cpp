// SPDX-License-Identifier: Apache-2.0
#include "vehicle/machines.h"

#include <cmath>

#include "scene_io/loader.h"

namespace navvy::vehicle::testing {

scene::Link box_link(const std::string& name, const Pose& X_ML, double mass, const Vec3& center, const Vec3& edges) {
  scene::Link link;
  link.name = name;
  link.X_ML = X_ML;
  link.mass = mass;
  link.p_LCom = center;
  const Vec3 s = edges.cwiseProduct(edges);
  link.inertia = Vec3(s.y() + s.z(), s.x() + s.z(), s.x() + s.y()).asDiagonal();
  link.inertia *= mass / 12;
  return link;
}

scene::Joint revolute(const std::string& name, int parent, int child, const Vec3& axis) {
  scene::Joint joint;
  joint.name = name;
  joint.type = scene::Joint::Type::kRevolute;
  joint.parent = parent;
  joint.child = child;
  joint.axis = axis;
  return joint;
}

scene::Machine cart() {
  scene::Machine m;
  m.name = "cart";
  m.links.push_back(box_link("chassis", Pose::Identity(), 1600, Vec3(1.4, 0, 0.8), Vec3(3, 1.5, 0.5)));
  m.has_drive = true;
  m.drive.tractive_force = 15e3;
  m.drive.power = 30e3;
  m.drive.brake_force = 25e3;
  const auto add = [&](const Pose& X, double mass, const std::string& name, int parent, const Vec3& axis) {
    m.links.push_back(box_link(name, X, mass, Vec3::Zero(), Vec3(0.8, 0.3, 0.8)));
    m.joints.push_back(revolute(name + "_joint", parent, static_cast<int>(m.links.size()) - 1, axis));
  };
  for (const bool front : {true, false})
    for (const bool left : {true, false}) {
      const Pose X = make_pose(front ? 2.8 : 0, left ? 0.97 : -0.97, 0.525);
      const std::string name = std::string(front ? "front_" : "rear_") + (left ? "left" : "right");
      int carrier = 0;
      scene::Wheel wheel;
      if (front) {
        add(X, 20, "steer_" + name, 0, Vec3::UnitZ());
        carrier = static_cast<int>(m.links.size()) - 1;
        wheel.steer_joint = m.joints.back().name;
        m.joints.back().effort = 5e3;
      }
      add(X, front ? 80 : 100, name, carrier, Vec3::UnitY());
      wheel.joint = m.joints.back().name;
      wheel.driven = !front;
      wheel.stiffness = 4e5;
      wheel.damping = 4e3;
      m.wheels.push_back(wheel);
    }
  return m;
}

scene::Machine arm() {
  scene::Machine m;
  m.name = "arm";
  m.fixed_base = true;
  m.links.push_back(box_link("base", Pose::Identity(), 1000, Vec3::Zero(), Vec3(1, 1, 1)));
  m.links.push_back(box_link("boom", make_pose(0, 0, 2), 1200, Vec3(2.5, 0, 0.3), Vec3(5, 0.4, 0.6)));
  m.links.push_back(box_link("stick", make_pose(5, 0, 2), 600, Vec3(1.2, 0, 0), Vec3(3, 0.3, 0.4)));
  m.joints.push_back(revolute("boom_joint", 0, 1, -Vec3::UnitY()));
  m.joints.push_back(revolute("stick_joint", 1, 2, -Vec3::UnitY()));
  for (scene::Joint& joint : m.joints) {
    joint.effort = 500e3;
    joint.velocity = 0.6;
  }
  return m;
}

scene::Machine box() {
  scene::Machine m;
  m.name = "box";
  m.links.push_back(box_link("box", Pose::Identity(), 1000, Vec3::Zero(), Vec3(1, 1, 1)));
  scene::Collision collision;
  collision.name = "cube";
  collision.friction = 0.5;
  m.links[0].collisions.push_back(collision);
  return m;
}

scene::Machine dumper() { return scene_io::load_machine(scene_io::find_data("vehicles/dumper/model.sdf")); }

scene::Machine ew180(double boom, double stick, double bucket, double swing) {
  scene::Machine m = scene_io::load_machine(scene_io::find_data("vehicles/ew180/model.sdf"));
  const auto set = [&](const std::string& name, double q) {
    m.joints.at(static_cast<std::size_t>(m.joint_index(name))).initial = q;
  };
  set(m.boom_joint, boom);
  set(m.stick_joint, stick);
  set(m.bucket_joint, bucket);
  set(m.swing_joint, swing);
  return m;
}

Vec3 FunctionGround::normal(double x, double y) const {
  constexpr double kHalf = 0.05;
  const double dx = (height_(x + kHalf, y) - height_(x - kHalf, y)) / (2 * kHalf);
  const double dy = (height_(x, y + kHalf) - height_(x, y - kHalf)) / (2 * kHalf);
  return Vec3(-dx, -dy, 1).normalized();
}

FunctionGround flat(double friction) {
  return FunctionGround([](double, double) { return 0.0; }, friction);
}

FunctionGround slope(double angle, double friction) {
  return FunctionGround([t = std::tan(angle)](double x, double) { return t * x; }, friction);
}

void run(Engine& engine, const GroundQuery& ground, double duration, double dt,
         const std::function<void(double)>& each) {
  const int steps = static_cast<int>(std::lround(duration / dt));
  for (int i = 1; i <= steps; ++i) {
    engine.step(dt, ground);
    if (each) each(i * dt);
  }
}

std::uint64_t digest(const Engine& engine) {
  StateHash hash;
  engine.hash(hash);
  return hash.digest();
}

}  // namespace navvy::vehicle::testing
