// SPDX-License-Identifier: Apache-2.0
// Errors that say where, what value, which rule and what to do.
#pragma once

#include <stdexcept>
#include <string>
#include <vector>

namespace navvy {

/// Base of every exception Navvy throws. `what()` is the complete message for a person. It holds
/// what went wrong, where and what to do, so a program prints it as it is and adds nothing. Whoever
/// catches it may go on with another scene; objects that were being built are gone.
class Error : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// One fault of a file or of an input. Fields that do not apply stay empty and leave no trace in
/// the text. Loaders put faults into a list and throw them together, so that a person mends a file
/// in one go and not a fault a run.
struct Fault {
  // A warning is told and the run goes on; an error ends it before the first step.
  enum class Severity { kError, kWarning };
  Severity severity = Severity::kError;
  std::string file;     ///< path as the user wrote it; empty when the fault is not in a file
  int line = 0;         ///< 1-based; 0 when unknown
  std::string element;  ///< element path or key, e.g. "world/navvy:soil[loam]/cohesion_pa"
  std::string value;    ///< what was found
  std::string rule;     ///< what is allowed
  std::string remedy;   ///< what to do

  /// `file:line: error: element: value 'x': rule (remedy)`. One fault without a line's end, ready
  /// for a terminal or a log.
  std::string text() const;
};

/// Bad input; carries every fault that was found, `what()` lists them one per line. Thrown by
/// whatever reads a file, a command line or a call of the library, always on, in every build.
class InputError : public Error {
 public:
  // Give it one fault at least. Its order is that of discovery, which for a file is from the top
  // down.
  explicit InputError(std::vector<Fault> faults);
  /// For readers that meet one fault and cannot go on.
  explicit InputError(Fault fault);
  /// For programs that show faults one by one, and for tests.
  const std::vector<Fault>& faults() const { return faults_; }

 private:
  std::vector<Fault> faults_;
};

/// A file could not be read or written (missing, permission, disk full). The text names the path
/// and the system's reason.
class FileError : public Error {
 public:
  using Error::Error;
};

/// An invariant of a running simulation broke (ledger open, NaN, runaway); the run stops with step
/// and time. It is not the user's doing: what can be known from the scene is refused as InputError
/// before a run starts.
class SimulationError : public Error {
 public:
  using Error::Error;
};

}  // namespace navvy
