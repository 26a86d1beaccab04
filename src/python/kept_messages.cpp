// SPDX-License-Identifier: Apache-2.0
#include "python/kept_messages.h"

#include <cstddef>
#include <mutex>

namespace navvy::python {
namespace {

/// Bounds the memory of a program that never looks at its messages.
constexpr std::size_t kMost = 1000;

struct Kept {
  std::mutex mutex;
  std::vector<std::pair<LogLevel, std::string>> messages;
};

Kept& kept() {
  // Never destroyed: a driver's thread may log while the process exits.
  static Kept& one = *new Kept;
  return one;
}

thread_local int quiet = 0;

}  // namespace

void keep_messages() {
  set_log_sink([](LogLevel level, const std::string& text) {
    if (quiet > 0) return;
    const std::lock_guard<std::mutex> alone(kept().mutex);
    if (kept().messages.size() < kMost) kept().messages.emplace_back(level, text);
  });
}

std::vector<std::pair<LogLevel, std::string>> take_messages() {
  const std::lock_guard<std::mutex> alone(kept().mutex);
  return std::exchange(kept().messages, {});
}

QuietHere::QuietHere() { ++quiet; }
QuietHere::~QuietHere() { --quiet; }

}  // namespace navvy::python
