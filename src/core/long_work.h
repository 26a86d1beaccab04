// SPDX-License-Identifier: Apache-2.0
// Names the work that a process cannot interrupt, for messages about a process that does not react.
#pragma once

namespace navvy {

/// Marks the work of the enclosing scope. Work in another thread replaces the mark, and the end of
/// either one restores what it found, so the mark is a hint for people. Costs two writes of a
/// pointer.
class LongWork {
 public:
  /// Begins the work. `what` is a literal that completes "stopped by a signal while ...", such as
  /// "the OpenCL driver was busy compiling kernels"; only the pointer is kept.
  explicit LongWork(const char* what) noexcept;
  ~LongWork();
  LongWork(const LongWork&) = delete;
  LongWork& operator=(const LongWork&) = delete;

 private:
  const char* before_;  ///< the mark that this one replaced
};

/// Returns the mark of the work that goes on, or null. Any thread and signal handlers may call it.
const char* long_work() noexcept;

}  // namespace navvy
