// SPDX-License-Identifier: Apache-2.0
// Collects the messages of GDAL instead of printing them.
#pragma once

#include <string>
#include <vector>

namespace navvy::heightfield {

/// While a session exists, GDAL's messages of this thread go to `errors()` and nothing reaches
/// stderr. Registers the drivers of GDAL on first use.
class GdalSession {
 public:
  /// Installs the error handler of this thread.
  GdalSession();
  ~GdalSession();
  GdalSession(const GdalSession&) = delete;
  GdalSession& operator=(const GdalSession&) = delete;

  /// Returns the failures so far, in order, without warnings.
  const std::vector<std::string>& errors() const { return errors_; }
  /// Returns the first failure, or `otherwise` where there is none. The first one names the cause;
  /// later ones follow from it.
  std::string cause(const std::string& otherwise) const {
    return errors_.empty() ? otherwise : errors_.front();
  }
  /// Adds a failure; GDAL's error handler calls it.
  void add(const std::string& message) { errors_.push_back(message); }

 private:
  std::vector<std::string> errors_;
};

}  // namespace navvy::heightfield
