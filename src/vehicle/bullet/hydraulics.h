// SPDX-License-Identifier: Apache-2.0
// Cylinders and pump of one machine: what force and speed they allow at its present pose, and who
// gets how much oil. Knows no engine.
#pragma once

#include <vector>

#include "vehicle/hydraulic_pump.h"
#include "vehicle/kinematics.h"

namespace navvy::vehicle {

/// The cylinders of a machine, each linkage worked out once a step: at the end of it, where place()
/// is called, for the outputs and for the step that follows. Everything else reads that.
class Hydraulics {
 public:
  /// @throws InputError as CylinderMap does, and for two cylinders on one joint (they are one with
  /// a count).
  explicit Hydraulics(const scene::Machine& machine);

  /// Index of the cylinders that act on a joint, -1: none.
  int of_joint(int joint) const { return of_joint_[static_cast<std::size_t>(joint)]; }
  /// The joint that a cylinder moves.
  int joint(int cylinder) const { return at(cylinder).map.joint(); }
  int count() const { return static_cast<int>(cylinders_.size()); }

  /// Tells the joint position [rad|m] at which a cylinder stands from now on.
  void place(int cylinder, double q);
  const CylinderGeometry& geometry(int cylinder) const { return at(cylinder).geometry; }
  /// Of effort and speed of the joint, at that place.
  const CylinderLimits& limits(int cylinder) const { return at(cylinder).limits; }

  /// False: every cylinder has its own flow, nothing is shared.
  bool has_pump() const { return machine_.has_pump; }
  /// Oil [m3/s] that the cylinders take while the joint moves at `velocity` [rad/s|m/s].
  double oil(int cylinder, double velocity) const;
  /// What a function asks of the pump: its valve would let the joint reach `opened`, its effort in
  /// the last step was `effort`; one whose valve is hardly open (`flows` false) sets no pressure.
  OilDemand demand(int cylinder, double opened, double effort, bool flows) const;

  /// Its memory is the machine's state; asked only when there is one.
  HydraulicPump& pump() { return pump_; }
  const HydraulicPump& pump() const { return pump_; }

 private:
  // Map of the linkage (constant), and what it gives at the present place.
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
