// SPDX-License-Identifier: Apache-2.0
// A file too large to be held, written piece by piece.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <string>

namespace navvy::planner {

/// Writes beside `path` and takes its place when it is whole; until then, and where anything fails,
/// the old file stands.
class PartFile {
 public:
  /// @throws FileError naming path and cause, as do all of these; also for what is there and is no
  /// plain file.
  explicit PartFile(const std::string& path);
  /// Removes what was not committed.
  ~PartFile();
  PartFile(const PartFile&) = delete;
  PartFile& operator=(const PartFile&) = delete;

  void write(const void* data, std::size_t count);
  /// Over bytes that were written before.
  void overwrite(std::uint64_t at, const void* data, std::size_t count);
  std::uint64_t size() const { return size_; }  ///< bytes written so far
  void commit();

 private:
  [[noreturn]] void fail();
  std::string path_, part_;
  std::FILE* file_;
  std::uint64_t size_ = 0;
};

}  // namespace navvy::planner
