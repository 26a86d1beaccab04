// SPDX-License-Identifier: Apache-2.0
// Exit status of the program; `navvy --help` and the README document it.
#pragma once

namespace navvy::cli {

/// Exit status of `navvy`. Scripts rely on the numbers, so they never change.
enum ExitCode {
  kOk = 0,
  kInternal = 1,    ///< error of Navvy itself
  kBadInput = 2,    ///< command line, scene, terrain or snapshot
  kDevice = 3,      ///< no OpenCL device, or it failed
  kFile = 4,        ///< a result could not be written (disk full, permission)
  kSimulation = 5,  ///< the simulation failed; failed.snapshot was written
  /// The run ended before a program of it did; all results are written.
  kIncomplete = 6,
  /// An experiment gave a result outside its acceptance range.
  kOutOfTolerance = 7,
  /// Ctrl-C, SIGTERM, SIGHUP, or a controller that went away; results up to then are complete.
  kInterrupted = 130
};

}  // namespace navvy::cli
