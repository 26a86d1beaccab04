// SPDX-License-Identifier: Apache-2.0
// Drive of a machine in the Bullet engine: it commands steering joints, drives and brakes wheels,
// and locks oscillating axles.
#pragma once

#include <memory>
#include <vector>

#include "vehicle/bullet/differential_row.h"
#include "vehicle/bullet/joints.h"
#include "vehicle/bullet/wheels.h"
#include "vehicle/drive/drive_line.h"

namespace navvy::vehicle {

/// Applies the commands and torques of a DriveLine to the joints and wheels of one machine. The
/// wheels of a machine without a drive turn freely, like those of a trailer.
///
/// After set_joint() has commanded a joint directly, the drive does not control that joint until
/// set() receives the next drive command.
class MachineDrive {
 public:
  /// Registers the joints of wheels, steering and oscillating axles. All four objects must exist as
  /// long as this one.
  MachineDrive(const scene::Machine& machine, TreeBody& tree, MachineJoints& joints,
               MachineWheels& wheels);

  /// Sets a new drive command. Joints that were commanded directly follow the drive again.
  void set(const DriveInput& input);
  /// Returns the command that the drive currently follows.
  const DriveInput& input() const { return input_; }

  /// Returns the constraint rows of all differentials that couple their shafts and of a carrier
  /// with a prescribed speed, for the engine's solver.
  const std::vector<std::unique_ptr<DifferentialRow>>& differentials() const { return rows_; }

  /// Commands steering joints and axles, and computes the torque or brake of every wheel for a step
  /// of `dt` [s]. Call it before MachineJoints::begin_step().
  void begin_step(double dt);
  /// Reads the shaft torques of a step of `dt` [s]. Call it after the solver and before
  /// MachineJoints::end_step().
  void end_step(double dt);

  /// Returns the torque of the half shaft that drives a wheel in the last step [N m].
  double shaft_torque(int wheel) const { return shaft_.at(static_cast<std::size_t>(wheel)); }
  /// Returns the state of the combustion engine; all zero without one.
  const CombustionEngineState& engine() const { return line_->engine(); }

  /// Saves, loads or hashes the drive command and the state of the drive line. Call it after the
  /// visit() of joints and wheels.
  void visit(Archive& a);

 private:
  /// Finds the joints of oscillating axles and casters: revolute joints between chassis and wheels
  /// that neither spin a wheel nor steer it.
  void find_axles();
  /// Commands the steering joints for this step.
  void steer();
  /// Locks oscillating axles and casters under the brake, and frees them otherwise.
  void lock_axles();
  /// Adds a constraint row that couples the spins of all wheels whose `weight` [-] is not zero.
  void add_row(const std::vector<double>& weight);
  /// Sets the limits of all differentials that are not open from the torques of this step, and the
  /// speed of a carrier with a prescribed speed.
  void couple(double dt);
  /// Holds a wheel at the angle at which it stopped, with a torque of at most `torque` [N m].
  void brake(MachineWheel& wheel, double torque, double dt);

  /// Scene data of the machine.
  const scene::Machine& machine_;
  /// Articulated tree of the machine.
  TreeBody& tree_;
  /// Joints of the machine.
  MachineJoints& joints_;
  /// Wheels of the machine.
  MachineWheels& wheels_;
  /// Drive line for the machine's type of drive. A machine without a drive has a default one, which
  /// is not used.
  std::unique_ptr<DriveLine> line_;
  /// Constant properties of each wheel.
  std::vector<DriveWheel> about_;
  /// Indices of the joints of oscillating axles and casters.
  std::vector<int> axles_;
  /// Rotation of each wheel in the current step.
  std::vector<WheelTurn> turns_;
  /// Torque of the drive line on each wheel in the current step [N m].
  std::vector<double> torque_;
  /// Torque of the half shaft to each wheel in the last step [N m].
  std::vector<double> shaft_;
  /// Differentials that are locked or have limited slip.
  std::vector<Coupled> coupled_;
  /// Weight of each wheel's spin in the speed of the differential carrier, if an engine of type
  /// speed source turns that carrier; empty for other engines.
  std::vector<double> carrier_;
  /// Constraint rows, one for each entry of `coupled_`, then one for the carrier of a speed source
  /// if there is one.
  std::vector<std::unique_ptr<DifferentialRow>> rows_;
  /// Current drive command.
  DriveInput input_;
};

}  // namespace navvy::vehicle
