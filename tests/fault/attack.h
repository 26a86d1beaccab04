// SPDX-License-Identifier: Apache-2.0
// One attack on a run, and the verdict on what it left. Used by the tests and by the campaign.
#pragma once

#include <sys/types.h>

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

namespace navvy::fault {

/// What is done to a run of `arguments`, which gets an --out of its own.
struct Attack {
  std::string fault;      ///< as the shim's NAVVY_FAULT; empty: none
  std::string hang;       ///< as its NAVVY_HANG
  std::string abort;      ///< as its NAVVY_ABORT
  double kill_after = 0;  ///< SIGKILL after so many seconds; 0: none
  /// [s] without any processor time, or with as much of it, count as hung: killed.
  double patience = 300;
  std::vector<std::pair<std::string, std::string>> environment;
};

struct Outcome {
  int status = 0;  ///< of the process, minus the signal that ended it
  double seconds = 0;
  std::string said;     ///< its standard error
  std::string summary;  ///< status in the summary; empty: none was left
  std::string hash;     ///< of the state, where the summary has it
  std::string broken;   ///< what is wrong with it; empty: survived
};

/// Processor time that a process has had [s], all its threads together; 0 when it is gone.
double processor_time(pid_t process);

/// Arguments of the run that is attacked: a fifth of a second of a bucket, with pictures where
/// `drawing`.
std::vector<std::string> small_run(bool drawing);

/// Runs it into `folder`/out, which is emptied before, and judges. `hash`: what the state must hash
/// to where the run ends well; empty: anything.
Outcome attack(const std::string& folder, const std::vector<std::string>& arguments,
               const Attack& with, const std::string& hash = "");

/// Why the files of a run are not whole; empty when they are. Tables of one that was `killed` may
/// end in a line without its end, which is no row.
std::string broken_files(const std::string& out, bool killed = false);

/// Kinds of calls that the shim counts and lets fail: open, write, fsync, rename, new, buffer.
constexpr std::size_t kKinds = 6;

/// How often the calls that the shim counts were made in the run, by name.
std::vector<std::pair<std::string, long>> count_calls(const std::string& folder,
                                                      const std::vector<std::string>& arguments,
                                                      const Attack& with);

}  // namespace navvy::fault
