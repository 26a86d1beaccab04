// SPDX-License-Identifier: Apache-2.0
// Cylinders and pump of one machine: the force and speed they allow at its present pose, and the
// distribution of oil. Independent of any engine.
#pragma once

#include <vector>

#include "vehicle/hydraulic_pump.h"
#include "vehicle/kinematics.h"

namespace navvy::vehicle {

/// Cylinders of a machine. Each linkage is evaluated once per step, by place() at the step's end,
/// for the outputs and for the next step.
class Hydraulics {
 public:
  /// Resolves the cylinders.
  /// @throws InputError as CylinderMap does, and for two cylinders on one joint (use one with a
  /// count).
  explicit Hydraulics(const scene::Machine& machine);

  /// Returns the index of the cylinders on a joint, -1: none.
  int of_joint(int joint) const { return of_joint_[static_cast<std::size_t>(joint)]; }
  /// Returns the joint that a cylinder moves.
  int joint(int cylinder) const { return at(cylinder).map.joint(); }
  /// Returns the number of cylinder entries of the machine.
  int count() const { return static_cast<int>(cylinders_.size()); }

  /// Sets the joint position [rad|m] of a cylinder.
  void place(int cylinder, double q);
  /// Returns length, lever and pins at the present position.
  const CylinderGeometry& geometry(int cylinder) const { return at(cylinder).geometry; }
  /// Returns the limits of the joint's effort and speed at that position.
  const CylinderLimits& limits(int cylinder) const { return at(cylinder).limits; }

  /// Returns whether cylinders share a pump. Without one every cylinder has its own flow.
  bool has_pump() const { return machine_.has_pump; }
  /// Returns the oil [m3/s] that the cylinders take while the joint moves at `velocity`
  /// [rad/s|m/s].
  double oil(int cylinder, double velocity) const;
  /// Returns the demand of a function: with its valve the joint would reach `opened`, its effort in
  /// the last step was `effort`. A function whose valve is nearly closed (`flows` false) sets no
  /// pressure.
  OilDemand demand(int cylinder, double opened, double effort, bool flows) const;

  /// Returns the pump, whose state is the machine's. Call it only for a machine with a pump.
  HydraulicPump& pump() { return pump_; }
  const HydraulicPump& pump() const { return pump_; }

 private:
  // Constant map of the linkage, and its values at the present position.
  struct Cylinder {
    CylinderMap map;
    CylinderGeometry geometry;
    CylinderLimits limits;
  };
  const Cylinder& at(int i) const { return cylinders_[static_cast<std::size_t>(i)]; }

  const scene::Machine& machine_;
  std::vector<Cylinder> cylinders_;  // by machine.cylinders
  std::vector<int> of_joint_;
  HydraulicPump pump_;
};

}  // namespace navvy::vehicle
