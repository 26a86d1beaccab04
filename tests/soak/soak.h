// SPDX-License-Identifier: Apache-2.0
// Hours of repeated scoops in one process, continued by the next process, and the claims they
// support.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "device/device.h"
#include "soak/claims.h"

namespace navvy::soak {

struct Plan {
  /// phases.csv, bytes.svg, snapshots and, in run/, the results of a run; an existing folder is
  /// continued.
  std::string folder;
  /// Total number of cycles, a multiple of four.
  long cycles = 0;
  /// Wall time between snapshots [s].
  double save_every = 60;
  /// Largest growth of bytes in use.
  Allowance allowance;
  /// Called after each cycle to ask whether to stop; may be empty.
  std::function<bool()> stop;
  /// Called with the number of finished cycles; may be empty.
  std::function<void(long)> after_cycle;
};

struct Result {
  /// Cycles of the long run.
  long reached = 0;
  /// Cycles that the resumed quarters have run, with an equal hash at each quarter's end.
  long compared = 0;
  /// Number of processes so far.
  int processes = 0;
  /// Maximum at equal phases, and growth after the first quarter.
  Bytes most, grown;
  /// Hash of the last state.
  std::string hash;
  /// Violated claims.
  std::vector<std::string> broken;
};

/// Runs the missing parts of the plan: first one session through all cycles, then four fresh ones,
/// each loaded from the snapshot of the one before at its quarter's end. After any interruption,
/// the next call continues. @throws InputError, FileError, SimulationError, device::DeviceError.
Result soak(device::Device& device, const Plan& plan);

/// Returns the result as text: hours reached, bytes, ledger, hashes, violated claims.
std::string summary(const Result& result, const Plan& plan);

/// Returns bytes.svg: bytes in use over simulated hours, one strip per kind.
std::string picture(const std::vector<Phase>& phases);

}  // namespace navvy::soak
