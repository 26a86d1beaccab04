// SPDX-License-Identifier: Apache-2.0
// GDAL kept quiet: its messages are collected instead of printed.
#pragma once

#include <string>
#include <vector>

namespace navvy::heightfield {

/// While one lives, GDAL's messages of this thread go into `errors()`; nothing reaches stderr.
/// Registers GDAL's drivers on first use.
class GdalSession {
 public:
  GdalSession();
  ~GdalSession();
  GdalSession(const GdalSession&) = delete;
  GdalSession& operator=(const GdalSession&) = delete;

  /// Failures (not warnings) so far, in order.
  const std::vector<std::string>& errors() const { return errors_; }
  /// The first failure, or `otherwise`: the first one names the cause, later ones follow from it.
  std::string cause(const std::string& otherwise) const {
    return errors_.empty() ? otherwise : errors_.front();
  }
  void add(const std::string& message) { errors_.push_back(message); }

 private:
  std::vector<std::string> errors_;
};

}  // namespace navvy::heightfield
