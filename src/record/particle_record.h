// SPDX-License-Identifier: Apache-2.0
// What a run records of its active soil.
#pragma once

#include <string>

namespace navvy::record {

/// Request to write the active soil of a run as files (particle_recorder.h).
struct ParticleRecord {
  /// Files per simulated second [1/s]; 0 for none.
  double rate = 0;
  /// Format of the files (formats/particle_files.h).
  std::string format = "vtu";
};

}  // namespace navvy::record
