// SPDX-License-Identifier: Apache-2.0
// A summary that can still be written when nothing else can: on a full disk, beside a thread that
// hangs, in a signal's handler.
#pragma once

#include <atomic>
#include <string>

namespace navvy::record {

/// Room on the disk for one summary, taken before the run, and the text for it, kept ready.
///
/// The last of these that was made is the one that `write_crash_summary` speaks for. Not
/// thread-safe apart from that.
class CrashSummary {
 public:
  /// Takes the room as `reserve`; `target` is what it becomes. @throws FileError when there is no
  /// room.
  CrashSummary(std::string reserve, std::string target);
  /// Gives the room back.
  ~CrashSummary();
  CrashSummary(const CrashSummary&) = delete;
  CrashSummary& operator=(const CrashSummary&) = delete;

  /// Keeps `summary`, whose status is "running", as what is known so far. A disk without room for a
  /// longer one leaves the text before it. Costs a copy.
  void keep(const std::string& summary);
  /// Puts `text` into the room and gives it the target's name. False when the disk refuses even
  /// that.
  bool write(const std::string& text) noexcept;

 private:
  friend bool write_crash_summary(const char* status, const char* message) noexcept;
  struct Text {
    std::string before, after;  ///< of `"status": "running"`
  };
  bool leave(const char* status, const char* message) noexcept;
  bool take_capacity(std::size_t bytes);

  std::string reserve_, target_;
  int file_ = -1;
  std::size_t room_ = 0;
  Text texts_[2];
  std::atomic<int> ready_{-1};  ///< which of the two holds; -1: none yet
};

/// Gives the summary of the run that is going on this status and message and the time of its last
/// checkpoint. Once; safe in a signal's handler and from any thread, which is why it takes plain
/// text. False when there is no such run.
bool write_crash_summary(const char* status, const char* message) noexcept;

}  // namespace navvy::record
