// SPDX-License-Identifier: Apache-2.0
// A run summary that can be written even when little else works: on a full disk, while another
// thread hangs, or in a signal handler.
#pragma once

#include <atomic>
#include <string>

namespace navvy::record {

/// Reserves disk space for one summary and keeps its latest text in memory, so that it can be
/// written in an emergency.
///
/// The reserved space is a file, which is renamed when it becomes the summary.
/// `write_crash_summary` uses the object that was constructed last. That function is thread-safe;
/// the rest of this class is not.
class CrashSummary {
 public:
  /// Creates the file `reserve` and fills it to reserve disk space. When the summary is written,
  /// the file is renamed to `target`.
  /// @throws FileError if the disk has no space for it.
  CrashSummary(std::string reserve, std::string target);
  /// Removes the reserved file, unless it was renamed to the summary.
  ~CrashSummary();
  CrashSummary(const CrashSummary&) = delete;
  CrashSummary& operator=(const CrashSummary&) = delete;

  /// Stores a copy of `summary` as the latest text. It must contain the status "running"; other
  /// texts are ignored. Keeps the previous text if the disk has no space for a longer one.
  void keep(const std::string& summary);
  /// Writes `text` into the reserved file and renames the file to the target. Returns true on
  /// success. Works once.
  bool write(const std::string& text) noexcept;

 private:
  friend bool write_crash_summary(const char* status, const char* message) noexcept;
  /// The parts of a summary before and after the entry `"status": "running"`, which a crash
  /// replaces.
  struct Text {
    /// Text before the status entry, and text after it.
    std::string before, after;
  };
  /// Writes the stored text with this status and message and renames the file to the target.
  /// Returns true on success. Safe in a signal handler.
  bool leave(const char* status, const char* message) noexcept;
  /// Extends the reserved file to at least `bytes`. Returns false if the disk is full.
  bool take_capacity(std::size_t bytes);

  /// Path of the reserved file, and path that it is renamed to.
  std::string reserve_, target_;
  /// Descriptor of the reserved file; -1 after it was renamed.
  int file_ = -1;
  /// Size of the reserved file [bytes].
  std::size_t reserved_ = 0;
  /// Two texts: one is valid while the other is being written.
  Text texts_[2];
  /// Index of the valid text in `texts_`, so that a signal handler never reads a text that is being
  /// changed; -1 if no text was stored yet.
  std::atomic<int> ready_{-1};
};

/// Writes the summary of the current run with this status and message; all other values are those
/// of the last checkpoint. Only the first call has an effect. Safe in a signal handler and from any
/// thread. Returns false if there is no run or the summary cannot be written.
bool write_crash_summary(const char* status, const char* message) noexcept;

}  // namespace navvy::record
