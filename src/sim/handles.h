// SPDX-License-Identifier: Apache-2.0
// Handles to the parts of a running world: a name or an index is resolved once, and reading then
// neither searches nor allocates. `world.machines().at("excavator").link("boom").pose()`,
// `.joint("arm_joint").position()`, `.tool("bucket").force()`, `.wheel(0).state().slip`.
//
// A handle is a few words and copied freely. It is valid as long as its world lives and always
// reads the present state, also after a snapshot was loaded. Handles only read:
// sim::MachineCommands and sim::Inputs drive, and Session's functions where a program may be
// running. Every look-up throws InputError for a name or index that does not exist; for a name the
// message holds the nearest one.
#pragma once

#include <cstdint>
#include <string>

#include "core/math.h"
#include "scene/machine.h"
#include "sim/world_measurements.h"
#include "vehicle/machine_state.h"

namespace navvy::vehicle {
// Forward declared: a client reads through handles and includes no engine.
class PhysicsEngine;
class JointEncoder;
}  // namespace navvy::vehicle

namespace navvy::sim {

struct WorldParts;

/// Rigid link L of a machine. Frame L is the link's own frame in the machine's file, W the world.
class LinkHandle {
 public:
  /// Returns the name of the link in its machine's file.
  const std::string& name() const;
  /// Returns X_WL, the pose of the link in the world.
  Pose pose() const;
  /// Returns the velocity of L's origin, axes of W [m/s].
  Vec3 velocity() const;
  /// Returns the angular velocity, axes of W [rad/s].
  Vec3 angular_velocity() const;
  /// Returns pose [m], velocity [m/s] and angular velocity [rad/s] in one read, axes of W.
  vehicle::LinkState state() const;

 private:
  friend class MachineHandle;
  const scene::Link* link_ = nullptr;
  const vehicle::PhysicsEngine* engine_ = nullptr;
  int body_ = -1, index_ = -1;
};

/// Joint of a machine. Units follow its type: [rad], [rad/s], [N m] for a revolute joint, [m],
/// [m/s], [N] for a prismatic one.
class JointHandle {
 public:
  /// Returns the name of the joint in its machine's file.
  const std::string& name() const;
  /// Return the indices into scene::Scene::machines and scene::Machine::joints.
  int machine() const { return machine_; }
  int index() const { return index_; }
  /// Returns the position. Zero is the pose in the machine's file; wheels count beyond a turn.
  double position() const;
  /// Returns the velocity, positive along or about the joint's axis.
  double velocity() const;
  /// Returns the effort that the servo applied in the last step.
  double effort() const;
  /// Returns the register of its encoder, 0 to 2^bits - 1. @throws InputError for a joint without
  /// one.
  std::uint64_t counts() const;
  /// Returns the whole state in one read: also limits, cylinder force [N] and length [m], stalled.
  vehicle::JointState state() const;

 private:
  friend class MachineHandle;
  const scene::Joint* joint_ = nullptr;
  const vehicle::PhysicsEngine* engine_ = nullptr;
  const vehicle::JointEncoder* encoder_ = nullptr;
  int machine_ = -1, body_ = -1, index_ = -1;
};

/// Wheel with its tyre.
class WheelHandle {
 public:
  /// Returns the name of its spin joint.
  const std::string& name() const;
  /// Returns pose (y = spin axis), velocity [m/s], spin [rad/s], steer [rad], tyre force [N], slip
  /// [-] and sinkage [m].
  vehicle::WheelState state() const;

 private:
  friend class MachineHandle;
  const scene::Wheel* wheel_ = nullptr;
  const vehicle::PhysicsEngine* engine_ = nullptr;
  int body_ = -1, index_ = -1;
};

/// Shell that touches soil: a bucket, a bed, a blade. Forces are those of the ground on it, axes of
/// W.
class ToolHandle {
 public:
  /// Returns the name of its shell, unique in its machine.
  const std::string& name() const;
  /// Returns the index into scene::Scene::machines.
  int machine() const;
  /// Return whether the machine's file declares the shell a bucket or a bed; both false for a blade
  /// or plate.
  bool is_bucket() const;
  bool is_bed() const;
  /// Returns the mean soil force over the last completed transfer [N].
  Vec3 force() const;
  /// Returns its moment about the link's origin [N m].
  Vec3 moment() const;
  /// Returns the force, low-passed at 3 Hz [N]: for display and control.
  Vec3 smooth_force() const;
  /// Returns the force of the rock, low-passed in the same way [N]; zero for a kinematic machine.
  Vec3 rock_force() const;
  /// Returns the soil inside [kg]; for a bed without the soil in a bucket inside it. Costs a pass
  /// over the particles.
  double payload() const;
  /// Returns the momentum balance of the last step, see world_measurements.h. `scale` is 0 without
  /// contact.
  MomentumBalance momentum_balance() const;

 private:
  friend class MachineHandle;
  friend class Machines;
  const WorldParts* parts_ = nullptr;
  /// Index into Coupling::tools.
  int tool_ = -1;
};

/// Machine of the scene.
class MachineHandle {
 public:
  /// Returns the name of the instance in the scene ("excavator"), not of the model.
  const std::string& name() const;
  /// Returns the index into scene::Scene::machines.
  int index() const { return machine_; }
  /// Returns the data it was built from: names, counts, limits.
  const scene::Machine& description() const;

  /// Return a part by name, or by index as in scene::Machine::links, joints, wheels (named by their
  /// spin joint) and shells. Link 0 is the base.
  LinkHandle link(const std::string& name) const;
  LinkHandle link(int index) const;
  JointHandle joint(const std::string& name) const;
  JointHandle joint(int index) const;
  WheelHandle wheel(const std::string& name) const;
  WheelHandle wheel(int index) const;
  ToolHandle tool(const std::string& name) const;
  ToolHandle tool(int index) const;

  /// Returns oil flow [m3/s] and pressure [Pa] of the last step; zeros without a pump.
  vehicle::PumpState pump() const;
  /// Returns speed [rad/s], torque [N m], power [W] and gear of its combustion engine after the
  /// last step; zeros for a drive without one.
  vehicle::CombustionEngineState engine() const;
  /// Returns the command that the drive follows now: speed [m/s], steer [rad], brake, gear.
  vehicle::DriveInput drive() const;
  /// Returns the target pose of a kinematic machine's base; for other machines the present pose.
  vehicle::BaseInput base() const;
  /// Returns the stability on its wheels. Costs a pass over its links.
  vehicle::Stability stability() const;
  /// Returns the work done by drives and cylinders since the start [J].
  double work() const;

 private:
  friend class Machines;
  const WorldParts* parts_ = nullptr;
  int machine_ = -1;
};

}  // namespace navvy::sim
