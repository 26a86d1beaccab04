// SPDX-License-Identifier: Apache-2.0
// Errors that say where, what value, which rule and what to do.
#pragma once

#include <stdexcept>
#include <string>
#include <vector>

namespace navvy {

/// Base of every exception Navvy throws. `what()` is the complete message for a person.
class Error : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// One fault of a file or of an input.
struct Fault {
  enum class Severity { kError, kWarning };
  Severity severity = Severity::kError;
  std::string file;     ///< path as the user wrote it; empty when the fault is not in a file
  int line = 0;         ///< 1-based; 0 when unknown
  std::string element;  ///< element path or key, e.g. "world/navvy:soil[loam]/cohesion_pa"
  std::string value;    ///< what was found
  std::string rule;     ///< what is allowed
  std::string remedy;   ///< what to do

  /// `file:line: error: element: value 'x': rule (remedy)`.
  std::string text() const;
};

/// Bad input; carries every fault that was found, `what()` lists them one per line.
class InputError : public Error {
 public:
  explicit InputError(std::vector<Fault> faults);
  explicit InputError(Fault fault);
  const std::vector<Fault>& faults() const { return faults_; }

 private:
  std::vector<Fault> faults_;
};

/// A file could not be read or written (missing, permission, disk full).
class FileError : public Error {
 public:
  using Error::Error;
};

/// An invariant of a running simulation broke (ledger open, NaN, runaway); the run stops with step and time.
class SimulationError : public Error {
 public:
  using Error::Error;
};

}  // namespace navvy
