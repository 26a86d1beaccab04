// SPDX-License-Identifier: Apache-2.0
#include "vehicle/bullet/wheels.h"

#include "vehicle/bullet/refuse.h"
#include "vehicle/kinematics.h"

namespace navvy::vehicle {
namespace {

/// Returns the axes of a wheel that do not spin with it: y along the axle, x level and ahead in the
/// carrier.
Pose wheel_pose(const Pose& X_WC, const Vec3& axis_C, const Vec3& center_C) {
  const Vec3 axis = X_WC.linear() * axis_C;
  Vec3 ahead = axis.cross(X_WC.linear().col(2));
  // An axle along the carrier's z has no forward direction: any will do.
  if (ahead.norm() < 0.1) ahead = axis.unitOrthogonal();
  ahead.normalize();
  // Right-handed: ahead, axle, and up as their product.
  Pose X = Pose::Identity();
  X.linear().col(0) = ahead;
  X.linear().col(1) = axis;
  X.linear().col(2) = ahead.cross(axis);
  X.translation() = X_WC * center_C;
  return X;
}

}  // namespace

// Resolves joints and links of every wheel once.
MachineWheels::MachineWheels(const scene::Machine& machine, TreeBody& tree)
    : machine_(machine), tree_(tree) {
  for (const scene::Wheel& about : machine.wheels) {
    MachineWheel wheel;
    wheel.spin_joint = machine.joint_index(about.joint);
    if (wheel.spin_joint < 0) refuse("wheel", about.joint, "no joint of this name");
    const scene::Joint& joint = machine.joints[static_cast<std::size_t>(wheel.spin_joint)];
    if (joint.type != scene::Joint::Type::kRevolute || joint.parent < 0)
      refuse("wheel", about.joint, "a wheel spins on a revolute joint of the machine");
    wheel.wheel_link = joint.child;
    wheel.carrier_link = joint.parent;
    const scene::Link& link = machine.links[static_cast<std::size_t>(joint.child)];
    // Its inertia about the axle limits an explicit step of the spin.
    const Vec3 axis_L = joint.X_LcJ.linear() * joint.axis.normalized();
    wheel.spin_inertia = axis_L.dot(link.inertia * axis_L);
    // Axle and centre are fixed in the carrier, however the wheel has turned.
    const Pose X_CL = joint_pose(machine, joint, 0);
    wheel.axis_C = X_CL.linear() * axis_L;
    wheel.center_C = X_CL * Vec3(joint.X_LcJ.translation());
    if (!about.steer_joint.empty()) {
      wheel.steer_joint = machine.joint_index(about.steer_joint);
      if (wheel.steer_joint < 0) refuse("wheel", about.steer_joint, "no joint of this name");
    }
    if (about.track) {
      wheel.running_track = terramechanics::TrackState::of(*about.track);
      wheel.body_shear.assign(terramechanics::track_stations(about, wheel.center_C).size(),
                              {Vec2::Zero(), Vec2::Zero()});
      if (tree.bullet_of_joint(wheel.spin_joint) < 0)
        refuse("track", about.joint, "its sprocket cannot turn");
    }
    wheels_.push_back(wheel);
  }
}

// The carrier's motion, with the wheel's spin kept apart. It is the motion by which the wheel has
// moved: an impulse of the soil on the machine's tools has changed velocities since, but the ground
// answers to it in the step that moves the wheel. Otherwise a loaded truck at rest would creep.
terramechanics::TyreMotion MachineWheels::motion(const MachineWheel& wheel) const {
  // Use the carrier: the wheel's own link spins, and its pose has no forward direction.
  const LinkState carrier = tree_.moved_link(wheel.carrier_link);
  terramechanics::TyreMotion motion;
  motion.X_WWheel = wheel_pose(carrier.X_WL, wheel.axis_C, wheel.center_C);
  motion.w_W = carrier.w_WL;
  motion.v_W =
      carrier.v_WL + carrier.w_WL.cross(motion.X_WWheel.translation() - carrier.X_WL.translation());
  motion.spin = tree_.moved_velocity(wheel.spin_joint);
  motion.spin_inertia = wheel.spin_inertia;
  return motion;
}

// Tracks and tyres follow different laws.
Vec3 MachineWheels::push(const terramechanics::GroundQuery& ground, double dt) {
  // Apply to the wheel's link: the force reaches the carrier through the axle, the moment about the
  // axle only the wheel.
  Vec3 impulse = Vec3::Zero();
  for (std::size_t w = 0; w < wheels_.size(); ++w) {
    MachineWheel& wheel = wheels_[w];
    if (machine_.wheels[w].track) {
      push_ground_track(w, ground, dt);
      impulse += dt * wheel.force.force_W;
      continue;
    }
    const terramechanics::TyreMotion now = motion(wheel);
    wheel.force = terramechanics::tyre_force(machine_.wheels[w], now, ground, dt, wheel.tyre);
    tree_.add_force(wheel.wheel_link, wheel.force.force_W, wheel.force.moment_W,
                    now.X_WWheel.translation());
    impulse += dt * wheel.force.force_W;
  }
  return impulse;
}

terramechanics::TrackMotion MachineWheels::track_motion(const MachineWheel& wheel) const {
  const LinkState carrier = tree_.moved_link(wheel.carrier_link);
  terramechanics::TrackMotion motion;
  motion.X_WC = carrier.X_WL;
  motion.v_W = carrier.v_WL;
  motion.w_W = carrier.w_WL;
  motion.p_sprocket = wheel.center_C;
  motion.spin = tree_.moved_velocity(wheel.spin_joint);
  motion.spin_inertia = wheel.spin_inertia;
  return motion;
}

// The spin of the sprocket is the track's speed.
void MachineWheels::push_ground_track(std::size_t w, const terramechanics::GroundQuery& ground,
                                      double dt) {
  MachineWheel& wheel = wheels_[w];
  const terramechanics::TrackForce force = terramechanics::track_force(
      machine_.wheels[w], track_motion(wheel), ground, dt, wheel.running_track);
  // The carrier takes the forces on the lower run; their part along the track goes to the sprocket
  // as a torque.
  for (const terramechanics::TrackForce::Push& push : force.pushes)
    tree_.add_force(wheel.carrier_link, push.f_W, Vec3::Zero(), push.p_W);
  tree_.multibody().addJointTorque(tree_.bullet_of_joint(wheel.spin_joint), force.torque);
  wheel.force = {};
  wheel.force.force_W = force.force_W;
  wheel.force.slip = force.slip;
  wheel.force.sinkage = force.sinkage;
}

std::vector<terramechanics::TrackPatch> MachineWheels::track_patches(int i) const {
  const auto w = static_cast<std::size_t>(i);
  if (!machine_.wheels.at(w).track) return {};
  return terramechanics::track_patches(machine_.wheels[w], track_motion(wheels_[w]),
                                       wheels_[w].running_track);
}

WheelState MachineWheels::state(int i) const {
  // Motion is the present one, force and slip are those of the last step.
  const MachineWheel& wheel = wheels_.at(static_cast<std::size_t>(i));
  const terramechanics::TyreMotion now = motion(wheel);
  WheelState state;
  state.X_WWheel = now.X_WWheel;
  state.v_W = now.v_W;
  state.spin = now.spin;
  state.steer = wheel.steer_joint >= 0 ? tree_.position(wheel.steer_joint) : 0;
  state.force_W = wheel.force.force_W + wheel.body_W;
  state.body_W = wheel.body_W;
  state.body_p_W = machine_.wheels[static_cast<std::size_t>(i)].track
                       ? Vec3(tree_.link(wheel.carrier_link).X_WL * wheel.body_p_C)
                       : Vec3(now.X_WWheel.translation());
  state.slip = wheel.force.slip;
  state.sinkage = wheel.force.sinkage;
  return state;
}

void MachineWheel::visit(Archive& a) {
  a("tyre", tyre);
  a("force", force);
  a("held_spin", held_spin);
  a("braked", braked);
  if (!running_track.contacts.empty()) a.fixed("track", running_track.contacts);
}

}  // namespace navvy::vehicle
