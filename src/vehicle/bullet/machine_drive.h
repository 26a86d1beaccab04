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

/// Puts what a DriveLine says into joints and wheels. A machine without a drive has wheels that
/// turn freely, as a trailer's do.
///
/// A joint that set_joint took over is left alone until the next command of the drive.
class MachineDrive {
 public:
  /// Takes the joints of wheels, steering and oscillating axles. All references must outlive it.
  MachineDrive(const scene::Machine& machine, TreeBody& tree, MachineJoints& joints,
               MachineWheels& wheels);

  /// A new command; joints that were taken over are the drive's again.
  void set(const DriveInput& input);
  /// The command that is followed now.
  const DriveInput& input() const { return input_; }

  /// Rows that hold shafts together, for the engine's solver.
  const std::vector<std::unique_ptr<DifferentialRow>>& differentials() const { return rows_; }

  /// Before the joints' part of a step: commands of steering and axles, torque or brake of the
  /// wheels.
  void begin_step(double dt);
  /// After the solver and before the joints' part: what went through the shafts.
  void end_step(double dt);

  /// Torque of the half shaft to a wheel in the last step [N m].
  double shaft_torque(int wheel) const { return shaft_.at(static_cast<std::size_t>(wheel)); }
  const CombustionEngineState& engine() const { return line_->engine(); }

  /// The command, and the memory of the drive line. Visit joints and wheels before.
  void visit(Archive& a);

 private:
  /// Joints between chassis and wheels that neither spin nor steer.
  void find_axles();
  /// Commands of steering joints and axles for this step.
  void steer();
  void lock_axles();
  /// Adds a row over these wheels by their weights.
  void add_row(const std::vector<double>& weight);
  /// Bounds of the differentials that are not open, by the torques of this step; the speed of a
  /// cage that is held.
  void couple(double dt);
  /// Holds a wheel where it stopped with `torque` [N m] at most.
  void brake(MachineWheel& wheel, double torque, double dt);

  const scene::Machine& machine_;
  TreeBody& tree_;
  MachineJoints& joints_;
  MachineWheels& wheels_;
  // Of the default drive, asked nothing, where the machine has none
  std::unique_ptr<DriveLine> line_;
  std::vector<DriveWheel> about_;  // by wheel
  // Joints between chassis and wheel carriers: oscillation, casters
  std::vector<int> axles_;
  std::vector<WheelTurn> turns_;  // of the present step, by wheel
  std::vector<double> torque_;    // likewise [N m]
  std::vector<double> shaft_;     // of the last step, by wheel [N m]
  std::vector<Coupled> coupled_;  // differentials that are not open
  // By wheel: weight of it in the cage that a source of speed turns; empty: none
  std::vector<double> carrier_;
  std::vector<std::unique_ptr<DifferentialRow>> rows_;  // one each, the cage's last
  DriveInput input_;
};

}  // namespace navvy::vehicle
