// SPDX-License-Identifier: Apache-2.0
// Cylinders and pump of one machine: the force and speed that they allow at the machine's current
// pose, and the distribution of oil. Independent of the physics engine.
#pragma once

#include <vector>

#include "vehicle/hydraulic_pump.h"
#include "vehicle/kinematics.h"

namespace navvy::vehicle {

/// All cylinders of a machine and the pump that feeds them.
///
/// Each linkage is evaluated once per step, by place() at the end of the step. The result serves
/// the outputs of this step and the limits of the next one.
class Hydraulics {
 public:
  /// Resolves the names of all cylinders. `machine` must exist as long as this object.
  /// @throws InputError as CylinderMap does, and for two cylinder entries on one joint (a single
  /// entry may have a count).
  explicit Hydraulics(const scene::Machine& machine);

  /// Returns the index of the cylinder entry on a joint; -1 if the joint has none.
  int of_joint(int joint) const { return of_joint_[static_cast<std::size_t>(joint)]; }
  /// Returns the index of the joint that a cylinder entry moves.
  int joint(int cylinder) const { return at(cylinder).map.joint(); }
  /// Returns the number of the machine's cylinder entries.
  int count() const { return static_cast<int>(cylinders_.size()); }

  /// Evaluates a cylinder's geometry and limits at the position `q` [rad|m] of its joint.
  void place(int cylinder, double q);
  /// Returns a cylinder's length, lever arm and pins at the position set by place().
  const CylinderGeometry& geometry(int cylinder) const { return at(cylinder).geometry; }
  /// Returns a cylinder's limits of joint effort and speed at the position set by place().
  const CylinderLimits& limits(int cylinder) const { return at(cylinder).limits; }

  /// Returns true if the cylinders share a pump. Without a pump, each cylinder always gets its own
  /// full flow.
  bool has_pump() const { return machine_.has_pump; }
  /// Returns the flow of oil [m3/s] into a cylinder while its joint moves at `velocity`
  /// [rad/s|m/s].
  double oil(int cylinder, double velocity) const;
  /// Returns the demand of a cylinder for oil. `opened` is the joint velocity that its valve passes
  /// with enough oil [rad/s|m/s], `effort` the joint's effort in the last step [N m|N]. If `flows`
  /// is false, the valve is nearly closed, and the demand has no pressure.
  OilDemand demand(int cylinder, double opened, double effort, bool flows) const;

  /// Returns the machine's pump, whose state is part of the machine's state. A machine without a
  /// pump has one that stays idle.
  HydraulicPump& pump() { return pump_; }
  /// Returns the machine's pump.
  const HydraulicPump& pump() const { return pump_; }

 private:
  /// Cylinder entry with its values at the current joint position.
  struct Cylinder {
    /// Constant data of the cylinder and its linkage.
    CylinderMap map;
    /// Geometry at the position set by place().
    CylinderGeometry geometry;
    /// Limits of joint effort and speed at the position set by place().
    CylinderLimits limits;
  };
  /// Returns the cylinder entry with index `i`.
  const Cylinder& at(int i) const { return cylinders_[static_cast<std::size_t>(i)]; }

  /// Scene data of the machine.
  const scene::Machine& machine_;
  /// Cylinder entries in the order of machine.cylinders.
  std::vector<Cylinder> cylinders_;
  /// Index of the cylinder entry on each joint; -1 without one.
  std::vector<int> of_joint_;
  /// Pump that feeds all cylinders.
  HydraulicPump pump_;
};

}  // namespace navvy::vehicle
