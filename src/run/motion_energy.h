// SPDX-License-Identifier: Apache-2.0
// Energy that a machine takes for one motion with soil and for the same motion without, per tonne
// moved: after the two kinds of tests of [ISO 11152].
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "run/run_end.h"
#include "scene/scene.h"

namespace navvy::device {
class Device;
}

namespace navvy::run {

/// Work of one joint [J]: the sum of effort times speed while both have the same sign. A load that
/// drives its actuator returns nothing.
struct JointWork {
  std::string joint;        ///< name of the joint
  double with_soil = 0;     ///< work in the motion with soil [J]
  double without_soil = 0;  ///< work in the motion without soil [J]
};

/// Energy of one motion.
struct MotionEnergy {
  /// Work of all joints and of the drive [J] (sim::MachineHandle::work).
  double work = 0;
  /// Energy of the pump [J]: flow times pressure. 0 for a machine without a pump.
  double pump = 0;
};

/// Result of compare_motion_energy().
struct EnergyComparison {
  /// End of the motion with soil: kComplete, kFellShort, kOutOfTime or kForbidden.
  RunEnd end;
  /// One line for each program that did not reach its end (session::report_line).
  std::vector<std::string> unfinished;
  std::string machine;            ///< name of the machine in the scene
  double duration = 0;            ///< simulated time of each motion [s]
  double moved = 0;               ///< mass that was dug [kg], as in `earthwork` of summary.json
  int cycles = 0;                 ///< number of digging cycles of the machine's program
  MotionEnergy with_soil;         ///< energy of the motion in the scene
  MotionEnergy without_soil;      ///< energy of the same motion without soil at its tools
  std::vector<JointWork> joints;  ///< work of the arm's joints and of all joints with a cylinder
  /// Root mean square and largest distance between the paths of the bucket's edge in both motions,
  /// in the frame of the machine's base [m].
  double path_rms = 0, path_largest = 0;
};

/// Runs a scene twice and compares the energies of one of its machines.
///
/// The first run is that of the scene, with its programs. The second one repeats the motion: it has
/// no programs and no tools that touch soil, each joint of the arm and each joint with a cylinder
/// is commanded to the position and speed that it had, and each drive as it was. Machines stand on
/// the same ground and ride on it; hitches stay as they are at the start. A program that falls
/// short and an event that the scene forbids end the motion, and both energies are those up to
/// there.
///
/// The mass is what the whole site lost to digging, so that no other machine may dig: none may have
/// both a program and a tool that touches soil, apart from a bed.
///
/// @param machine name of the machine, which has a `navvy:bucket`; empty if only one machine does
/// @param progress called with the completed share of both runs, 0 to 1; may be empty
/// @throws InputError for a machine that is missing, ambiguous, kinematic or without a bucket, for
/// a second machine that may dig, and for a scene that cannot be built; SimulationError if a run
/// fails.
EnergyComparison compare_motion_energy(const scene::Scene& scene, const std::string& machine,
                                       device::Device& device,
                                       const std::function<void(double)>& progress = {});

}  // namespace navvy::run
