// SPDX-License-Identifier: Apache-2.0
// Handles to the parts of a running world: a name or an index is resolved once, then reading takes
// neither a look-up nor memory. `world.machine("excavator").link("boom").pose()`,
// `.joint("arm_joint").position()`, `.tool("bucket").force()`, `.wheel(0).state().slip`.
//
// A handle is a few words, copied freely; it stays valid as long as its world lives and tells the
// state of the moment in which it is read, also after a snapshot was loaded. Handles only read:
// World::command and World::set drive, and Session's functions of the same names where a program
// may be running. Every look-up throws InputError for a name or index that does not exist; for a
// name the message holds the nearest one.
#pragma once

#include <cstdint>
#include <string>

#include "core/math.h"
#include "scene/machine.h"
#include "sim/world_measurements.h"
#include "vehicle/machine_state.h"

namespace navvy::vehicle {
// Named only: a client reads through handles and sees no engine.
class PhysicsEngine;
class JointEncoder;
}  // namespace navvy::vehicle

namespace navvy::sim {

struct WorldParts;

/// A rigid link L of a machine. Frame L is the link's own of the machine's file, W the world.
class LinkHandle {
 public:
  const std::string& name() const;
  /// X_WL: the link in the world.
  Pose pose() const;
  /// Of L's origin, axes of W [m/s].
  Vec3 velocity() const;
  /// Axes of W [rad/s].
  Vec3 angular_velocity() const;
  /// All of it in one read: pose [m], velocity [m/s] and angular velocity [rad/s], axes of W.
  vehicle::LinkState state() const;

 private:
  friend class MachineHandle;
  const scene::Link* link_ = nullptr;
  const vehicle::PhysicsEngine* engine_ = nullptr;
  int body_ = -1, index_ = -1;
};

/// A joint; units follow its type: [rad], [rad/s], [N m] of a revolute one, [m], [m/s], [N] of a
/// prismatic one.
class JointHandle {
 public:
  const std::string& name() const;
  /// Indices into scene::Scene::machines and scene::Machine::joints.
  int machine() const { return machine_; }
  int index() const { return index_; }
  /// Zero is the pose of the machine's file; wheels count on beyond a turn.
  double position() const;
  /// Positive as the joint's axis says.
  double velocity() const;
  /// As the servo applied it in the last step.
  double effort() const;
  /// Register of its encoder, 0 to 2^bits - 1. @throws InputError for a joint without one.
  std::uint64_t counts() const;
  /// All of it in one read: limits, cylinder force [N] and length [m], stalled or not.
  vehicle::JointState state() const;

 private:
  friend class MachineHandle;
  const scene::Joint* joint_ = nullptr;
  const vehicle::PhysicsEngine* engine_ = nullptr;
  const vehicle::JointEncoder* encoder_ = nullptr;
  int machine_ = -1, body_ = -1, index_ = -1;
};

/// A wheel with its tyre.
class WheelHandle {
 public:
  /// Name of its spin joint.
  const std::string& name() const;
  /// Pose (y = spin axis), velocity [m/s], spin [rad/s], steer [rad], tyre force [N], slip [-],
  /// sinkage [m].
  vehicle::WheelState state() const;

 private:
  friend class MachineHandle;
  const scene::Wheel* wheel_ = nullptr;
  const vehicle::PhysicsEngine* engine_ = nullptr;
  int body_ = -1, index_ = -1;
};

/// A shell that touches soil: a bucket, a bed, a blade. Forces are what the ground does to it, axes
/// of W.
class ToolHandle {
 public:
  /// Name of its shell, unique in its machine.
  const std::string& name() const;
  /// Index into scene::Scene::machines.
  int machine() const;
  /// What the machine's file says it is for; neither for a blade or plate.
  bool is_bucket() const;
  bool is_bed() const;
  /// Mean soil force of the last step [N].
  Vec3 force() const;
  /// Its moment about the link's origin [N m].
  Vec3 moment() const;
  /// The force, low-passed at 3 Hz [N]: for display and control.
  Vec3 smooth_force() const;
  /// Force of the rock, low-passed likewise [N]; zero for a kinematic machine.
  Vec3 rock_force() const;
  /// Soil inside [kg]; of a bed without what a bucket holds in it. Costs a pass over the particles.
  double payload() const;
  /// Of the last step, see world_measurements.h; scale 0 without contact.
  MomentumBalance momentum_balance() const;

 private:
  friend class MachineHandle;
  friend class World;
  const WorldParts* parts_ = nullptr;
  int tool_ = -1;  ///< index into Coupling::tools
};

/// A machine of the scene.
class MachineHandle {
 public:
  /// Of the instance in the scene, "excavator", not of the model.
  const std::string& name() const;
  /// Index into scene::Scene::machines.
  int index() const { return machine_; }
  /// The data it was built from: names, counts, limits.
  const scene::Machine& description() const;

  /// By name, or by index as in scene::Machine::links, joints, wheels (by the name of their spin
  /// joint), shells. Link 0 is the base.
  LinkHandle link(const std::string& name) const;
  LinkHandle link(int index) const;
  JointHandle joint(const std::string& name) const;
  JointHandle joint(int index) const;
  WheelHandle wheel(const std::string& name) const;
  WheelHandle wheel(int index) const;
  ToolHandle tool(const std::string& name) const;
  ToolHandle tool(int index) const;

  /// Oil flow [m3/s] and pressure [Pa] of the last step; zeros without a pump.
  vehicle::PumpState pump() const;
  /// Speed [rad/s], torque [N m], power [W] and gear of its engine after the last step; zeros of a
  /// drive without one.
  vehicle::CombustionEngineState engine() const;
  /// The command that the drive follows now: speed [m/s], steer [rad], brake, gear.
  vehicle::DriveInput drive() const;
  /// Where a kinematic machine's base is on its way to; of others where it is.
  vehicle::BaseInput base() const;
  /// How it stands on its wheels. Costs a pass over its links.
  vehicle::Stability stability() const;
  /// Done by drives and cylinders since the start [J].
  double work() const;

 private:
  friend class World;
  const WorldParts* parts_ = nullptr;
  int machine_ = -1;
};

}  // namespace navvy::sim
