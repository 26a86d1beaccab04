// SPDX-License-Identifier: Apache-2.0
#include "vehicle/machines.h"

#include <cmath>

#include "core/saved_state.h"
#include "scene_io/loader.h"

namespace navvy::vehicle::testing {

scene::Link box_link(const std::string& name, const Pose& X_ML, double mass, const Vec3& center,
                     const Vec3& edges) {
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
  m.links.push_back(
      box_link("chassis", Pose::Identity(), 1600, Vec3(1.4, 0, 0.8), Vec3(3, 1.5, 0.5)));
  m.has_drive = true;
  scene::AckermannDrive drive;
  drive.tractive_force = 15e3;
  drive.power = 30e3;
  drive.brake_force = 25e3;
  m.drive = drive;
  const auto add = [&](const Pose& X, double mass, const std::string& name, int parent,
                       const Vec3& axis) {
    m.links.push_back(box_link(name, X, mass, Vec3::Zero(), Vec3(0.8, 0.3, 0.8)));
    m.joints.push_back(
        revolute(name + "_joint", parent, static_cast<int>(m.links.size()) - 1, axis));
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
  m.links.push_back(
      box_link("boom", make_pose(0, 0, 2), 1200, Vec3(2.5, 0, 0.3), Vec3(5, 0.4, 0.6)));
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

scene::Machine dumper() {
  return scene_io::load_machine(scene_io::find_data("vehicles/dumper/model.sdf"));
}

scene::Machine ew180(double boom, double stick, double bucket, double swing) {
  scene::Machine m = scene_io::load_machine(scene_io::find_data("vehicles/ew180/model.sdf"));
  const auto set = [&](const std::string& name, double q) {
    m.joints.at(static_cast<std::size_t>(m.joint_index(name))).initial = q;
  };
  set(m.arm.boom, boom);
  set(m.arm.stick, stick);
  set(m.arm.bucket, bucket);
  set(m.arm.swing, swing);
  return m;
}

scene::Machine with_grip(scene::Machine machine, double friction) {
  for (scene::Wheel& wheel : machine.wheels) wheel.friction = friction;
  return machine;
}

scene::Machine robot(double caster) {
  scene::Machine m;
  m.name = "robot";
  m.links.push_back(
      box_link("chassis", Pose::Identity(), 40, Vec3(-0.08, 0, 0.16), Vec3(0.5, 0.3, 0.12)));
  m.has_drive = true;
  scene::DifferentialDrive drive;
  drive.max_speed = 1.5;
  drive.tractive_force = 120;
  drive.power = 100;
  drive.brake_force = 150;
  drive.track = 0.4;
  m.drive = drive;
  const auto add = [&](const std::string& name, const Vec3& p, double radius, bool driven) {
    m.links.push_back(box_link(name, make_pose(p.x(), p.y(), p.z()), 2, Vec3::Zero(),
                               Vec3(radius, 0.05, radius)));
    m.joints.push_back(
        revolute(name + "_joint", 0, static_cast<int>(m.links.size()) - 1, Vec3::UnitY()));
    scene::Wheel wheel;
    wheel.joint = m.joints.back().name;
    wheel.driven = driven;
    wheel.radius = radius;
    wheel.width = 0.04;
    wheel.stiffness = 4e4;
    wheel.damping = 400;
    wheel.friction = driven ? 0.9 : caster;
    m.wheels.push_back(wheel);
  };
  add("left", Vec3(0, 0.2, 0.1), 0.1, true);
  add("right", Vec3(0, -0.2, 0.1), 0.1, true);
  add("ball", Vec3(-0.3, 0, 0.05), 0.05, false);
  return m;
}

void run(PhysicsEngine& engine, const GroundQuery& ground, double duration, double dt,
         const std::function<void(double)>& each) {
  const int steps = static_cast<int>(std::lround(duration / dt));
  for (int i = 1; i <= steps; ++i) {
    engine.step(dt, ground);
    if (each) each(i * dt);
  }
}

std::uint64_t digest(const PhysicsEngine& engine) { return hash_of(engine).digest(); }

}  // namespace navvy::vehicle::testing
