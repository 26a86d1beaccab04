// SPDX-License-Identifier: Apache-2.0
// Handles to the parts of a running world: machines, links, joints, wheels and tools. A handle is
// looked up once by name or index; reading through it then neither searches nor allocates memory.
// Examples: `world.machines().at("excavator").link("boom").pose()`,
// `.joint("arm_joint").position()`, `.tool("bucket").force()`, `.wheel(0).state().slip`.
//
// A handle consists of a few pointers and indices and is cheap to copy. It is valid as long as its
// world exists and always reads the world's current state, also after a snapshot was loaded.
// Handles only read. Commands go through sim::MachineCommands and sim::Inputs, or through the
// functions of Session if a program may be running. Every look-up throws InputError for a name or
// index that does not exist; for a name, the message contains the most similar existing name.
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

/// Handle to one rigid link of a machine. L is the link's frame as the machine's file defines it; W
/// is the world frame.
class LinkHandle {
 public:
  /// Returns the link's name in the machine's file.
  const std::string& name() const;
  /// Returns X_WL, the pose of the link in the world.
  Pose pose() const;
  /// Returns the velocity of the origin of L, in axes of W [m/s].
  Vec3 velocity() const;
  /// Returns the angular velocity of the link, in axes of W [rad/s].
  Vec3 angular_velocity() const;
  /// Returns pose [m], velocity [m/s] and angular velocity [rad/s] of the link in one read, in axes
  /// of W.
  vehicle::LinkState state() const;

 private:
  friend class MachineHandle;
  const scene::Link* link_ = nullptr;
  const vehicle::PhysicsEngine* engine_ = nullptr;
  /// Index of the machine in its physics engine, and index of the link in its machine.
  int body_ = -1, index_ = -1;
};

/// Handle to one joint of a machine. Position, velocity and effort have the units rad, rad/s and N
/// m for a revolute joint, and m, m/s and N for a prismatic joint.
class JointHandle {
 public:
  /// Returns the joint's name in the machine's file.
  const std::string& name() const;
  /// Returns the index of the joint's machine in scene::Scene::machines.
  int machine() const { return machine_; }
  /// Returns the index of the joint in scene::Machine::joints.
  int index() const { return index_; }
  /// Returns the joint position [rad or m]. It is zero in the pose of the machine's file. The
  /// position of a wheel's joint keeps increasing beyond one turn.
  double position() const;
  /// Returns the joint velocity [rad/s or m/s], positive along or about the joint axis.
  double velocity() const;
  /// Returns the torque [N m] or force [N] that the joint's servo applied in the last step.
  double effort() const;
  /// Returns the register value of the joint's encoder, 0 to 2^bits - 1.
  /// @throws InputError for a joint without an encoder.
  std::uint64_t counts() const;
  /// Returns all state values of the joint in one read: position, velocity and effort, their
  /// limits, the cylinder's force [N] and length [m], and whether the joint is stalled or braked.
  vehicle::JointState state() const;

 private:
  friend class MachineHandle;
  const scene::Joint* joint_ = nullptr;
  const vehicle::PhysicsEngine* engine_ = nullptr;
  /// Encoder on this joint; null if it has none.
  const vehicle::JointEncoder* encoder_ = nullptr;
  /// Index of the machine in the scene, index of the machine in its physics engine, and index of
  /// the joint in its machine.
  int machine_ = -1, body_ = -1, index_ = -1;
};

/// Handle to one wheel of a machine, including its tyre.
class WheelHandle {
 public:
  /// Returns the name of the joint that the wheel spins about; a wheel has no name of its own.
  const std::string& name() const;
  /// Returns the wheel's pose in W (y is the spin axis), velocity [m/s], spin [rad/s], steering
  /// angle [rad], tyre force [N], slip [-] and sinkage [m].
  vehicle::WheelState state() const;

 private:
  friend class MachineHandle;
  const scene::Wheel* wheel_ = nullptr;
  const vehicle::PhysicsEngine* engine_ = nullptr;
  /// Index of the machine in its physics engine, and index of the wheel in its machine.
  int body_ = -1, index_ = -1;
};

/// Handle to one tool of a machine: a steel shell that touches soil, such as a bucket, a bed or a
/// blade. Forces are those of soil or rock on the tool, in axes of the world frame W.
class ToolHandle {
 public:
  /// Returns the name of the tool's shell, which is unique within its machine.
  const std::string& name() const;
  /// Returns the index of the tool's machine in scene::Scene::machines.
  int machine() const;
  /// Returns true if the machine's file declares the shell a bucket; false for a bed, blade or
  /// plate.
  bool is_bucket() const;
  /// Returns true if the machine's file declares the shell a bed; false for a bucket, blade or
  /// plate.
  bool is_bed() const;
  /// Returns the force of the soil on the tool [N], averaged over the last completed transfer
  /// between particles and grid.
  Vec3 force() const;
  /// Returns the part of force() that acts on the edges of the tool's plates, teeth included [N].
  Vec3 edge_force() const;
  /// Returns the moment of the soil on the tool about the origin of the tool's link [N m], averaged
  /// over the last completed transfer between particles and grid.
  Vec3 moment() const;
  /// Returns the force of the soil on the tool after a low-pass filter with 3 Hz [N], for display
  /// and control.
  Vec3 smooth_force() const;
  /// Returns the force of rock on the tool after a low-pass filter with 3 Hz [N]; zero for a
  /// kinematic machine.
  Vec3 rock_force() const;
  /// Returns the mass of the soil inside the tool [kg]. Soil in a bucket that is inside a bed
  /// counts for the bucket, not for the bed. Costs a pass over all particles.
  double payload() const;
  /// Returns the momentum balance between the tool and the soil in the last step. Its `scale` is 0
  /// if the tool touched no soil.
  MomentumBalance momentum_balance() const;

 private:
  friend class MachineHandle;
  friend class Machines;
  const WorldParts* parts_ = nullptr;
  /// Index of this tool in Coupling::tools, the list of all tools of the world.
  int tool_ = -1;
};

/// Handle to one machine of a scene.
class MachineHandle {
 public:
  /// Returns the machine's name in the scene ("excavator"), not the name of its model.
  const std::string& name() const;
  /// Returns the machine's index in scene::Scene::machines.
  int index() const { return machine_; }
  /// Returns the model that the machine was built from: its links, joints, wheels, shells and
  /// limits. The reference is valid as long as the world exists.
  const scene::Machine& description() const;

  /// Returns the link of this name.
  LinkHandle link(const std::string& name) const;
  /// Returns the link with this index in scene::Machine::links; link 0 is the base.
  LinkHandle link(int index) const;
  /// Returns the joint of this name.
  JointHandle joint(const std::string& name) const;
  /// Returns the joint with this index in scene::Machine::joints.
  JointHandle joint(int index) const;
  /// Returns the wheel whose spin joint has this name.
  WheelHandle wheel(const std::string& name) const;
  /// Returns the wheel with this index in scene::Machine::wheels.
  WheelHandle wheel(int index) const;
  /// Returns the tool whose shell has this name.
  ToolHandle tool(const std::string& name) const;
  /// Returns the tool whose shell has this index in scene::Machine::shells.
  ToolHandle tool(int index) const;

  /// Returns oil flow [m3/s] and pressure [Pa] of the machine's hydraulic pump in the last step;
  /// both are 0 for a machine without a pump.
  vehicle::PumpState pump() const;
  /// Returns speed [rad/s], torque [N m], power [W] and gear of the machine's combustion engine
  /// after the last step; all are 0 for a machine without one.
  vehicle::CombustionEngineState engine() const;
  /// Returns the command that the machine's drive currently follows: speed [m/s], steering angle
  /// [rad], brake and gear.
  vehicle::DriveInput drive() const;
  /// Returns the target pose of a kinematic machine's base link; for other machines, the current
  /// pose of that link.
  vehicle::BaseInput base() const;
  /// Returns the machine's stability against tipping over. Costs a pass over all links of the
  /// machine.
  vehicle::Stability stability() const;
  /// Returns the work that the machine's drives and cylinders have done since the start of the
  /// simulation [J].
  double work() const;

 private:
  friend class Machines;
  const WorldParts* parts_ = nullptr;
  /// Index of the machine in scene::Scene::machines.
  int machine_ = -1;
};

}  // namespace navvy::sim
