// SPDX-License-Identifier: Apache-2.0
// Hours of repeated scoops in one process, gone on with by the next one, and what they prove.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "device/device.h"
#include "soak/claims.h"

namespace navvy::soak {

struct Plan {
  std::string
      /// phases.csv, bytes.svg, snapshots and, in run/, what a run leaves; gone on with when it is
      /// there.
      folder;
  long cycles = 0;                        ///< that the whole shall have, a multiple of four
  double save_every = 60;                 ///< [s] of wall time between snapshots to go on from
  Allowance allowance;                    ///< what bytes in use may grow by
  std::function<bool()> stop;             ///< asked after each cycle; may be empty
  std::function<void(long)> after_cycle;  ///< told how many are done; may be empty
};

struct Result {
  long reached = 0;  ///< cycles of the one long run
  /// Cycles that the resumed quarters have gone through, to an equal hash at each quarter's end.
  long compared = 0;
  int processes = 0;                ///< that took turns
  Bytes most, grown;                ///< at equal phases; after the first quarter
  std::string hash;                 ///< of the last state
  std::vector<std::string> broken;  ///< claims that do not hold
};

/// Runs what is missing of the plan: first one session through all cycles, then four fresh ones,
/// each loaded from the snapshot that the one before left at its quarter's end. Whatever stopped
/// it, the next call goes on.
/// @throws InputError, FileError, SimulationError, device::DeviceError.
Result soak(device::Device& device, const Plan& plan);

/// What came of it, for people: hours reached, bytes, ledger, hashes, claims that do not hold.
std::string told(const Result& result, const Plan& plan);

/// bytes.svg: bytes in use over simulated hours, each kind by itself.
std::string picture(const std::vector<Phase>& phases);

}  // namespace navvy::soak
