// SPDX-License-Identifier: Apache-2.0
// Drive of a machine in the Bullet engine: steers joints, drives and brakes wheels, locks axles.
#pragma once

#include <memory>
#include <vector>

#include "vehicle/bullet/differential_row.h"
#include "vehicle/bullet/joints.h"
#include "vehicle/bullet/wheels.h"
#include "vehicle/drive/drive_line.h"

namespace navvy::vehicle {

/// Applies the commands and torques of a DriveLine to joints and wheels. The wheels of a machine
/// without a drive turn freely, as a trailer's do.
///
/// A joint that set_joint has taken over is not driven until the next command of the drive.
class MachineDrive {
 public:
  /// Registers the joints of wheels, steering and oscillating axles. All references must outlive
  /// this object.
  MachineDrive(const scene::Machine& machine, TreeBody& tree, MachineJoints& joints,
               MachineWheels& wheels);

  /// Sets a new command. Joints that were taken over return to the drive.
  void set(const DriveInput& input);
  /// Returns the command that the drive follows now.
  const DriveInput& input() const { return input_; }

  /// Returns the rows that couple shafts, for the engine's solver.
  const std::vector<std::unique_ptr<DifferentialRow>>& differentials() const { return rows_; }

  /// Commands steering and axles and computes torque or brake of the wheels. Call it before the
  /// joints' begin_step.
  void begin_step(double dt);
  /// Reads the shaft torques. Call it after the solver and before the joints' end_step.
  void end_step(double dt);

  /// Returns the torque of the half shaft to a wheel in the last step [N m].
  double shaft_torque(int wheel) const { return shaft_.at(static_cast<std::size_t>(wheel)); }
  /// Returns the state of the combustion engine; zeros without one.
  const CombustionEngineState& engine() const { return line_->engine(); }

  /// Visits the command and the state of the drive line. Visit joints and wheels before.
  void visit(Archive& a);

 private:
  /// Finds the joints between chassis and wheels that neither spin nor steer.
  void find_axles();
  /// Commands steering joints and axles for this step.
  void steer();
  void lock_axles();
  /// Adds a row over these wheels with their weights.
  void add_row(const std::vector<double>& weight);
  /// Sets the limits of the differentials that are not open, from the torques of this step, and the
  /// speed of a carrier with a prescribed speed.
  void couple(double dt);
  /// Holds a wheel where it stopped, with at most `torque` [N m].
  void brake(MachineWheel& wheel, double torque, double dt);

  const scene::Machine& machine_;
  TreeBody& tree_;
  MachineJoints& joints_;
  MachineWheels& wheels_;
  // The default drive, unused, for a machine without one.
  std::unique_ptr<DriveLine> line_;
  std::vector<DriveWheel> about_;  // by wheel
  std::vector<int> axles_;        // joints between chassis and wheel carriers: oscillation, casters
  std::vector<WheelTurn> turns_;  // of the present step, by wheel
  std::vector<double> torque_;    // of the present step, by wheel [N m]
  std::vector<double> shaft_;     // of the last step, by wheel [N m]
  std::vector<Coupled> coupled_;  // differentials that are not open
  // Weights by wheel of the carrier that a speed source turns; empty without one.
  std::vector<double> carrier_;
  // One row per differential, the carrier's last.
  std::vector<std::unique_ptr<DifferentialRow>> rows_;
  DriveInput input_;
};

}  // namespace navvy::vehicle
