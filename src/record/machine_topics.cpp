// SPDX-License-Identifier: Apache-2.0
#include "record/machine_topics.h"

#include "control/pursuit.h"
#include "formats/ros/urdf.h"

namespace navvy::record {
namespace {

namespace ros = formats::ros;

/// Returns the name of a frame in the tree of all machines.
std::string full_name(const sim::MachineHandle& machine, const std::string& frame) {
  return machine.name() + "/" + frame;
}

std::string odom_name(const sim::MachineHandle& machine) {
  return full_name(machine, ros::name_beside_links(machine.description(), "odom"));
}

Pose pose_of(const sim::MachineHandle& machine, const ros::MachineFrame& frame) {
  return machine.link(frame.link).pose() * frame.X_LF;
}

/// Returns the true pose of the machine's frame M.
Pose true_pose(const sim::MachineHandle& machine) {
  return machine.link(0).pose() * machine.description().links[0].X_ML.inverse();
}

/// Returns the true state of the root of a machine's frames.
ros::BodyState truth_of(const sim::MachineHandle& machine, const ros::MachineFrame& root) {
  const vehicle::LinkState link = machine.link(0).state();
  const Pose X_WB = link.X_WL * root.X_LF;
  // Velocity of the root's origin, which moves with the base link.
  const Vec3 p_LB_W = X_WB.translation() - link.X_WL.translation();
  const Mat3 R_BW = X_WB.linear().transpose();
  return {ros::kFrame, full_name(machine, root.name), X_WB,
          R_BW * (link.v_WL + link.w_WL.cross(p_LB_W)), R_BW * link.w_WL};
}

/// Returns the state of the joints that have a position: fixed joints and balls have none.
ros::JointStates joints_of(const sim::MachineHandle& machine) {
  ros::JointStates out;
  const std::vector<scene::Joint>& joints = machine.description().joints;
  for (std::size_t i = 0; i < joints.size(); ++i) {
    if (joints[i].type == scene::Joint::Type::kFixed || joints[i].type == scene::Joint::Type::kBall)
      continue;
    const sim::JointHandle joint = machine.joint(static_cast<int>(i));
    out.names.push_back(joint.name());
    out.positions.push_back(joint.position());
    out.velocities.push_back(joint.velocity());
    out.efforts.push_back(joint.effort());
  }
  return out;
}

}  // namespace

MachineTopics::MachineTopics(const sim::World& world, const std::vector<SensorStream>& sensors)
    : world_(world) {
  for (int m = 0; m < world.machines().count(); ++m) {
    const sim::MachineHandle machine = world.machines().at(m);
    machines_.push_back({machine, ros::machine_frames(machine.description()), {}});
    std::vector<ros::MachineFrame>& frames = machines_.back().frames;
    for (const SensorStream& sensor : sensors)
      if (sensor.machine == m)
        for (ros::MachineFrame frame : sensor.frames()) {
          frame.parent = ros::frame_of_link(frames, machine.description(), frame.link);
          frames.push_back(frame);
        }
    frames_.insert(odom_name(machine));
    for (const ros::MachineFrame& frame : frames) frames_.insert(full_name(machine, frame.name));
  }
  restart();
}

void MachineTopics::restart() {
  for (Entry& entry : machines_) start(entry);
}

void MachineTopics::start(Entry& entry) {
  entry.odometry.reset();
  auto wheels = control::wheel_odometry(entry.machine.description());
  if (!wheels) return;
  const Pose X_WM = true_pose(entry.machine);
  const Vec3 p_W = X_WM * Vec3(wheels->p_M.x(), wheels->p_M.y(), 0);
  const double yaw = control::plane_pose(X_WM).yaw;
  wheels->estimate.reset({p_W.head<2>(), yaw}, entry.machine.joint(wheels->left).counts(),
                         entry.machine.joint(wheels->right).counts());
  entry.odometry = Counted{*wheels, X_WM.translation().z(), 0, yaw, world_.time()};
}

void MachineTopics::observe() {
  for (Entry& entry : machines_)
    if (entry.odometry) {
      control::WheelOdometry& wheels = entry.odometry->wheels;
      wheels.estimate.update(entry.machine.joint(wheels.left).counts(),
                             entry.machine.joint(wheels.right).counts());
    }
}

// Speeds are differences since the last message: those of single counts would jump.
ros::BodyState MachineTopics::estimate(Entry& entry) const {
  Counted& odometry = *entry.odometry;
  const control::DifferentialOdometry& wheels = odometry.wheels.estimate;
  const ros::MachineFrame& root = entry.frames.front();
  const Pose X_MB = entry.machine.description().links[0].X_ML * root.X_LF;
  const control::PlanePose at = wheels.pose();
  Pose X_OM = make_pose(0, 0, 0, 0, 0, at.yaw);
  X_OM.translation() << at.p, odometry.z;
  X_OM.translation().head<2>() -= X_OM.linear().topLeftCorner<2, 2>() * odometry.wheels.p_M;
  ros::BodyState out{odom_name(entry.machine), full_name(entry.machine, root.name), X_OM * X_MB,
                     Vec3::Zero(), Vec3::Zero()};
  const double dt = world_.time() - odometry.time;
  if (dt > 0) {
    const Vec3 w_M(0, 0, (at.yaw - odometry.yaw) / dt);
    Vec3 p_M = X_MB.translation();
    p_M.head<2>() -= odometry.wheels.p_M;
    const Vec3 v_M = Vec3((wheels.distance() - odometry.distance) / dt, 0, 0) + w_M.cross(p_M);
    out.v_B = X_MB.linear().transpose() * v_M;
    out.w_B = X_MB.linear().transpose() * w_M;
  }
  odometry.distance = wheels.distance();
  odometry.yaw = at.yaw;
  odometry.time = world_.time();
  return out;
}

ros::MachineState MachineTopics::state_of(Entry& entry) {
  const sim::MachineHandle& machine = entry.machine;
  const ros::MachineFrame& root = entry.frames.front();
  ros::MachineState out;
  out.name = machine.name();
  out.truth = truth_of(machine, root);
  out.odometry = out.truth;
  out.odometry.parent = odom_name(machine);
  if (entry.odometry) {
    out.odometry = estimate(entry);
    out.transforms.push_back(
        {ros::kFrame, out.odometry.parent, out.truth.X_PB * out.odometry.X_PB.inverse()});
  }
  out.transforms.push_back({out.odometry.parent, out.odometry.frame, out.odometry.X_PB});
  for (const ros::MachineFrame& frame : entry.frames) {
    if (!ros::moves(machine.description(), frame)) continue;
    const ros::MachineFrame& parent = entry.frames[static_cast<std::size_t>(frame.parent)];
    out.transforms.push_back({full_name(machine, parent.name), full_name(machine, frame.name),
                              pose_of(machine, parent).inverse() * pose_of(machine, frame)});
  }
  out.joints = joints_of(machine);
  return out;
}

void MachineTopics::write_fixed(ros::Bag& bag, std::int64_t time_ns) const {
  std::vector<ros::Transform> fixed;
  for (const Entry& entry : machines_) {
    const scene::Machine& description = entry.machine.description();
    if (!entry.odometry) fixed.push_back({ros::kFrame, odom_name(entry.machine)});
    for (const ros::MachineFrame& frame : entry.frames) {
      if (frame.parent < 0 || ros::moves(description, frame)) continue;
      const ros::MachineFrame& parent = entry.frames[static_cast<std::size_t>(frame.parent)];
      fixed.push_back({full_name(entry.machine, parent.name), full_name(entry.machine, frame.name),
                       ros::pose_in_parent(description, entry.frames, frame)});
    }
    ros::write_description(bag, entry.machine.name(), ros::urdf(description, entry.frames),
                           time_ns);
  }
  ros::write_fixed(bag, fixed, time_ns);
}

void MachineTopics::write(ros::Bag& bag, std::int64_t time_ns) {
  if (!machines_.empty() && !bag.has("/tf_static")) write_fixed(bag, time_ns);
  std::vector<ros::MachineState> states;
  states.reserve(machines_.size());
  for (Entry& entry : machines_) states.push_back(state_of(entry));
  ros::write_machines(bag, states, time_ns);
}

}  // namespace navvy::record
