// SPDX-License-Identifier: Apache-2.0
// Exceptions whose messages state where the problem is, which value is wrong, which rule it
// violates and what to do.
#pragma once

#include <stdexcept>
#include <string>
#include <vector>

namespace navvy {

/// Base class of all exceptions that Navvy throws. `what()` is a complete message for people: what
/// went wrong, where, and what to do; programs print it unchanged. After catching an exception, a
/// program may continue with another scene; objects that were being constructed no longer exist.
class Error : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// One error or warning about a file or another input. Members that do not apply are empty and are
/// omitted from the text. Loaders collect faults and throw them together, so that a user can
/// correct all of them at once.
struct Fault {
  /// An error prevents the run from starting; a warning is logged and the run continues.
  enum class Severity { kError, kWarning };
  Severity severity = Severity::kError;  ///< error or warning
  std::string file;     ///< path as the user wrote it; empty if the fault is not in a file
  int line = 0;         ///< line number, starting from 1; 0: unknown
  std::string element;  ///< path of the element or key, e.g. "world/navvy:soil[loam]/cohesion_pa"
  std::string value;    ///< the invalid value as text
  std::string rule;     ///< the rule that the value violates
  std::string remedy;   ///< how the user can correct it

  /// Returns the fault as one line without a line end: `file:line: error: element: value 'x': rule
  /// (remedy)`.
  std::string text() const;
};

/// Exception for invalid input, with all errors and warnings found; `what()` lists them, one per
/// line. It is thrown, in all build types, by everything that reads a file or a command line, and
/// by library functions that check their arguments.
class InputError : public Error {
 public:
  /// Stores one or more faults in the order in which they were found; for a file, this is from top
  /// to bottom.
  explicit InputError(std::vector<Fault> faults);
  /// Stores a single fault, for readers that cannot continue after it.
  explicit InputError(Fault fault);
  /// Returns the faults in the order in which they were found.
  const std::vector<Fault>& faults() const { return faults_; }

 private:
  std::vector<Fault> faults_;  ///< faults in the order in which they were found
};

/// Exception for a file that cannot be read or written (missing, no permission, disk full). The
/// message contains the path and the reason given by the operating system.
class FileError : public Error {
 public:
  using Error::Error;
};

/// Exception for a violated invariant of a running simulation (mass balance, NaN, divergence). The
/// run stops and reports step and time. Invalid input is not a cause, as InputError refuses it
/// before a run starts.
class SimulationError : public Error {
 public:
  using Error::Error;
};

}  // namespace navvy
