// SPDX-License-Identifier: Apache-2.0
// Reads replay.jsonl while a run writes it.
#pragma once

#include <cstdint>
#include <deque>
#include <fstream>
#include <string>

#include "link/view_feed.h"

namespace navvy::link {

/// Hands the frames of a growing replay to a feed, in the time that the recording spans as nearly
/// as the run writes it: a run appends its rows every two seconds.
class ReplayFollower {
 public:
  /// Opens the file `path`. @throws FileError if it cannot be read; InputError if it has no header
  /// yet.
  explicit ReplayFollower(const std::string& path);

  /// Returns the first row of the file.
  const std::string& header() const { return header_; }
  /// Returns true if `path` still names the file that was opened.
  bool is_current() const;
  /// Adds the next frames to `feed`: of the rows that wait, a share, so that ten calls per second
  /// spread them evenly; `all` adds all. Rows that are damaged are left out.
  void step(ViewFeed& feed, bool all = false);

 private:
  /// Takes the rows that were appended since the last call.
  void read();
  /// Adds the frame of a row.
  static void add(const std::string& row, ViewFeed& feed);

  std::string path_;
  std::ifstream in_;
  /// Identity of the file that was opened.
  std::uint64_t device_ = 0, inode_ = 0;
  std::string header_;
  /// The part of a row that has no end yet.
  std::string unfinished_;
  std::deque<std::string> rows_;
};

}  // namespace navvy::link
