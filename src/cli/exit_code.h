// SPDX-License-Identifier: Apache-2.0
// What the program's exit status says; documented in `navvy --help` and the README.
#pragma once

namespace navvy::cli {

enum ExitCode {
  kOk = 0,
  kInternal = 1,    ///< a fault of Navvy's own
  kBadInput = 2,    ///< command line, scene, terrain or snapshot
  kDevice = 3,      ///< no OpenCL device, or it failed
  kFile = 4,        ///< a result could not be written (disk full, permission)
  kSimulation = 5,  ///< the run stopped itself; failed.snapshot was written
  /// The run ended, but a program of it did not come to its end; all results are there.
  kIncomplete = 6,
  /// An experiment of the laboratory ended outside a gate that holds for it.
  kOutOfTolerance = 7,
  /// Ctrl-C, SIGTERM, SIGHUP, or a controller that went away; results up to then are complete.
  kInterrupted = 130
};

}  // namespace navvy::cli
