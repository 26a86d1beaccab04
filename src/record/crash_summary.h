// SPDX-License-Identifier: Apache-2.0
// A summary that can be written when little else works: on a full disk, beside a thread that hangs,
// or in a signal handler.
#pragma once

#include <atomic>
#include <string>

namespace navvy::record {

/// Reserves disk space for one summary and holds its text in memory, ready to be written.
///
/// The space is a file that becomes the summary by a rename. `write_crash_summary` uses the object
/// that was constructed last. Apart from that function, this class is not thread-safe.
class CrashSummary {
 public:
  /// Creates and fills the file `reserve`, which will be renamed to `target`.
  /// @throws FileError when the disk has no space for it.
  CrashSummary(std::string reserve, std::string target);
  /// Removes the reserved file, unless it became the summary.
  ~CrashSummary();
  CrashSummary(const CrashSummary&) = delete;
  CrashSummary& operator=(const CrashSummary&) = delete;

  /// Stores `summary`, whose status is "running", as the latest known text. Keeps the previous text
  /// if the disk has no space for a longer one. Costs a copy.
  void keep(const std::string& summary);
  /// Writes `text` into the reserved file and renames it to the target. Returns false on failure.
  bool write(const std::string& text) noexcept;

 private:
  friend bool write_crash_summary(const char* status, const char* message) noexcept;
  /// A summary, split at `"status": "running"`.
  struct Text {
    std::string before, after;
  };
  /// Writes the stored text with this status and message. Safe in a signal handler.
  bool leave(const char* status, const char* message) noexcept;
  /// Grows the reserved file to at least `bytes`. Returns false if the disk is full.
  bool take_capacity(std::size_t bytes);

  std::string reserve_, target_;
  int file_ = -1;
  std::size_t reserved_ = 0;  ///< size of the reserved file [bytes]
  /// Two texts: one is valid while the other is written.
  Text texts_[2];
  /// Index of the valid text, so that a signal handler never reads one that changes; -1: none yet.
  std::atomic<int> ready_{-1};
};

/// Writes the summary of the active run with this status and message, as of its last checkpoint.
/// Works once. Safe in a signal handler and from any thread. Returns false when there is no run or
/// the summary cannot be written.
bool write_crash_summary(const char* status, const char* message) noexcept;

}  // namespace navvy::record
