// SPDX-License-Identifier: Apache-2.0
// A file too large to be held, written piece by piece.
#pragma once

#include <cstddef>
#include <cstdio>
#include <string>

namespace navvy::formats {

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
  void commit();

 private:
  [[noreturn]] void fail();
  std::string path_, part_;
  std::FILE* file_;
};

}  // namespace navvy::formats
