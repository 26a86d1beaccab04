// SPDX-License-Identifier: Apache-2.0
// Exceptions that say where, which value, which rule and what to do.
#pragma once

#include <stdexcept>
#include <string>
#include <vector>

namespace navvy {

/// Base of every exception that Navvy throws. `what()` is the complete message for a person: what
/// went wrong, where, and what to do. A program prints it as it is. After catching one, the program
/// may continue with another scene; objects that were under construction are gone.
class Error : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// One fault of a file or of an input. Fields that do not apply are empty and leave no trace in the
/// text. Loaders collect faults and throw them together, so that a person can correct a file in one
/// pass.
struct Fault {
  /// A warning is logged and the run continues; an error ends the run before its first step.
  enum class Severity { kError, kWarning };
  Severity severity = Severity::kError;
  /// Path as the user wrote it; empty if the fault is not in a file.
  std::string file;
  /// 1-based line number; 0 if unknown.
  int line = 0;
  /// Element path or key, e.g. "world/navvy:soil[loam]/cohesion_pa".
  std::string element;
  /// The value that was found.
  std::string value;
  /// The rule that the value breaks.
  std::string rule;
  /// Remedy: the action that corrects the fault.
  std::string remedy;

  /// Returns `file:line: error: element: value 'x': rule (remedy)`, one line without its end, ready
  /// for a terminal or a log.
  std::string text() const;
};

/// Bad input, with every fault that was found; `what()` lists them one per line. Thrown, in every
/// build type, by everything that reads a file or a command line, and by library functions that
/// check their arguments.
class InputError : public Error {
 public:
  /// Takes at least one fault. The order is that of discovery, which for a file is top down.
  explicit InputError(std::vector<Fault> faults);
  /// Takes a single fault, for readers that cannot continue after it.
  explicit InputError(Fault fault);
  /// Returns the faults, in the order of discovery.
  const std::vector<Fault>& faults() const { return faults_; }

 private:
  std::vector<Fault> faults_;
};

/// A file could not be read or written (missing, permission, disk full). The message names the path
/// and the system's reason.
class FileError : public Error {
 public:
  using Error::Error;
};

/// An invariant of a running simulation broke (ledger not balanced, NaN, divergence); the run stops
/// and reports step and time. It is not caused by bad input, which InputError refuses before a run
/// starts.
class SimulationError : public Error {
 public:
  using Error::Error;
};

}  // namespace navvy
