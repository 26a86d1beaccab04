// SPDX-License-Identifier: Apache-2.0
// Exit status of the `navvy` program, also documented in `navvy --help` and the README.
#pragma once

namespace navvy::cli {

/// Exit status of `navvy`. Scripts rely on the numbers, so they must never change.
enum ExitCode {
  /// The command succeeded.
  kOk = 0,
  /// The program failed because of an error in Navvy itself.
  kInternal = 1,
  /// The command line, a scene, a terrain file or a snapshot is invalid.
  kBadInput = 2,
  /// There is no OpenCL device, or the device failed.
  kDevice = 3,
  /// A result could not be written, for example because the disk is full.
  kFile = 4,
  /// The simulation failed, and failed.snapshot was written.
  kSimulation = 5,
  /// The run ended before one of its programs was completed. All results were written.
  kIncomplete = 6,
  /// A result of a laboratory experiment is outside its tolerance.
  kOutOfTolerance = 7,
  /// An event occurred that the scene forbids. All results were written.
  kForbidden = 8,
  /// All programs were completed, but the run missed a goal of the scene. All results were written.
  kMissedGoal = 9,
  /// A signal (Ctrl-C, SIGTERM, SIGHUP) or the loss of the controller ended the run. Results up to
  /// then are complete.
  kInterrupted = 130
};

}  // namespace navvy::cli
