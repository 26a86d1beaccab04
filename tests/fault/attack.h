// SPDX-License-Identifier: Apache-2.0
// One attack on a run, and the verdict on the files it left. Used by the tests and by the campaign.
#pragma once

#include <sys/types.h>

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

namespace navvy::fault {

/// Faults applied to a run of `arguments`, which gets an --out of its own.
struct Attack {
  /// Value of the shim's NAVVY_FAULT; empty: none.
  std::string fault;
  /// Value of its NAVVY_HANG.
  std::string hang;
  /// Value of its NAVVY_ABORT.
  std::string abort;
  double kill_after = 0;  ///< SIGKILL after so many seconds; 0: none
  /// A process without any processor time for this long, or with as much of it, counts as hung and
  /// is killed [s].
  double patience = 300;
  std::vector<std::pair<std::string, std::string>> environment;
};

struct Outcome {
  /// Exit status of the process, or minus the signal that ended it.
  int status = 0;
  double seconds = 0;
  /// Its standard error.
  std::string said;
  /// Status in the summary; empty if there is none.
  std::string summary;
  /// Hash of the state, if the summary has it.
  std::string hash;
  /// Fault found; empty if the run survived.
  std::string broken;
};

/// Returns the processor time of a process [s], summed over its threads; 0 after its end.
double processor_time(pid_t process);

/// Arguments of the attacked run: a fifth of a second of a bucket, with pictures if `drawing`.
std::vector<std::string> small_run(bool drawing);

/// Runs an attack into `folder`/out, which is emptied before, and judges it. `hash`: expected hash
/// of the state after a successful run; empty: any.
Outcome attack(const std::string& folder, const std::vector<std::string>& arguments,
               const Attack& with, const std::string& hash = "");

/// Returns why the files of a run are not intact; empty if they are. Tables of a `killed` run may
/// end in a line without its end, which is ignored.
std::string broken_files(const std::string& out, bool killed = false);

/// Kinds of calls that the shim counts and lets fail: open, write, fsync, rename, new, buffer.
constexpr std::size_t kKinds = 6;

/// Counts the calls of each kind that the shim counts in the run, by name.
std::vector<std::pair<std::string, long>> count_calls(const std::string& folder,
                                                      const std::vector<std::string>& arguments,
                                                      const Attack& with);

}  // namespace navvy::fault
