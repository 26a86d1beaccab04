// SPDX-License-Identifier: Apache-2.0
// Results of a slow function, kept for the whole process.
#pragma once

#include <cstddef>
#include <map>
#include <mutex>

namespace navvy {

/// Keeps the results of a function for the arguments that it was called with. Worlds of one process
/// mostly have the same soils and tools, and need not compute the same tables again.
///
/// Thread-safe; a function that takes long blocks other callers. At most `kMost` results are kept:
/// then all are dropped, as in a search over parameters no argument comes back.
template <class Key, class Value>
class Memo {
 public:
  /// Number of results that are kept.
  static constexpr std::size_t kMost = 64;

  /// Returns the result for `key`; calls `compute()` unless it is kept. If `compute` throws,
  /// nothing is kept.
  template <class Compute>
  Value at(const Key& key, const Compute& compute) {
    const std::lock_guard alone(mutex_);
    if (const auto found = values_.find(key); found != values_.end()) return found->second;
    if (values_.size() >= kMost) values_.clear();
    return values_.emplace(key, compute()).first->second;
  }

 private:
  std::mutex mutex_;
  std::map<Key, Value> values_;
};

}  // namespace navvy
