// SPDX-License-Identifier: Apache-2.0
// Collects the error messages of GDAL instead of printing them.
#pragma once

#include <string>
#include <vector>

namespace navvy::heightfield {

/// Collects the error messages that GDAL reports in this thread, as long as the session exists.
/// GDAL prints nothing to stderr meanwhile. The first session registers GDAL's file format drivers.
class GdalSession {
 public:
  /// Installs the error handler of this thread.
  GdalSession();
  /// Removes the error handler and clears GDAL's error state.
  ~GdalSession();
  GdalSession(const GdalSession&) = delete;
  GdalSession& operator=(const GdalSession&) = delete;

  /// Returns the error messages so far, oldest first, without warnings.
  const std::vector<std::string>& errors() const { return errors_; }
  /// Returns the first error message, or `otherwise` if there is none. The first message names the
  /// cause; later ones are consequences.
  std::string cause(const std::string& otherwise) const {
    return errors_.empty() ? otherwise : errors_.front();
  }
  /// Adds an error message. Called by GDAL's error handler.
  void add(const std::string& message) { errors_.push_back(message); }

 private:
  /// Error messages, oldest first.
  std::vector<std::string> errors_;
};

}  // namespace navvy::heightfield
