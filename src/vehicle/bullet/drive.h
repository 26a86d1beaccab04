// SPDX-License-Identifier: Apache-2.0
// The drive of a machine in the Bullet engine: steers joints, turns and brakes wheels, locks axles.
#pragma once

#include <memory>
#include <vector>

#include "vehicle/bullet/differential_row.h"
#include "vehicle/bullet/joints.h"
#include "vehicle/bullet/wheels.h"
#include "vehicle/drive/drive_line.h"

namespace navvy::vehicle {

/// Puts what a DriveLine says into joints and wheels. A machine without a drive has wheels that turn freely, as a
/// trailer's do.
///
/// A joint that set_joint took over is left alone until the next command of the drive.
class MachineDrive {
 public:
  /// Takes the joints of wheels, steering and oscillating axles. All references must outlive it.
  MachineDrive(const scene::Machine& machine, TreeBody& tree, MachineJoints& joints, MachineWheels& wheels);

  /// A new command; joints that were taken over are the drive's again.
  void set(const DriveInput& input);
  /// The command that is followed now.
  const DriveInput& input() const { return input_; }

  /// Rows that hold shafts together, for the engine's solver.
  const std::vector<std::unique_ptr<DifferentialRow>>& differentials() const { return rows_; }

  /// Before the joints' part of a step: commands of steering and axles, torque or brake of the wheels.
  void begin_step(double dt);

  /// The command, and the memory of the drive line's governors.
  void visit(Archive& a);

 private:
  /// Joints between chassis and wheels that neither spin nor steer.
  void find_axles();
  /// Commands of steering joints and axles for this step.
  void steer();
  void lock_axles();
  /// Bounds of the differentials that are not open, by the torques of this step.
  void couple(double dt);
  /// Holds a wheel where it stopped with `torque` [N m] at most.
  void brake(MachineWheel& wheel, double torque, double dt);

  const scene::Machine& machine_;
  TreeBody& tree_;
  MachineJoints& joints_;
  MachineWheels& wheels_;
  std::unique_ptr<DriveLine> line_;  // of the default drive, asked nothing, where the machine has none
  std::vector<DriveWheel> about_;    // by wheel
  std::vector<int> axles_;           // joints between chassis and wheel carriers: oscillation, casters
  std::vector<WheelTurn> turns_;     // of the present step, by wheel
  std::vector<double> torque_;       // likewise [N m]
  std::vector<Coupled> coupled_;     // differentials that are not open
  std::vector<std::unique_ptr<DifferentialRow>> rows_;  // one each
  DriveInput input_;
};

}  // namespace navvy::vehicle
