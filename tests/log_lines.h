// SPDX-License-Identifier: Apache-2.0
// Captures log lines of the libraries during a test.
#pragma once

#include <mutex>
#include <string>
#include <vector>

#include "core/log.h"

namespace navvy {

/// Captures every line that is logged during its lifetime, from any thread. Only one can exist at a
/// time, as there is one sink.
class LogLines {
 public:
  LogLines() {
    set_log_sink([this](LogLevel, const std::string& line) {
      const std::lock_guard<std::mutex> lock(mutex_);
      lines_.push_back(line);
    });
  }
  ~LogLines() { set_log_sink({}); }
  LogLines(const LogLines&) = delete;
  LogLines& operator=(const LogLines&) = delete;

  std::vector<std::string> lines() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return lines_;
  }
  /// Returns all lines, each with its line end.
  std::string text() const {
    std::string all;
    for (const std::string& line : lines()) all += line + "\n";
    return all;
  }

 private:
  mutable std::mutex mutex_;
  std::vector<std::string> lines_;
};

}  // namespace navvy
