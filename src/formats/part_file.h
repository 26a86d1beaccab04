// SPDX-License-Identifier: Apache-2.0
// A file too large for memory, written piece by piece.
#pragma once

#include <cstddef>
#include <cstdio>
#include <string>

namespace navvy::formats {

/// Writes beside `path` and replaces it when the file is complete. Until then, and after any error,
/// the old file stands.
class PartFile {
 public:
  /// Opens the partial file.
  /// @throws FileError naming path and cause, as all functions here do; also for a path that exists
  /// and is not a plain file.
  explicit PartFile(const std::string& path);
  /// Removes a file that was not committed.
  ~PartFile();
  PartFile(const PartFile&) = delete;
  PartFile& operator=(const PartFile&) = delete;

  /// Appends bytes.
  void write(const void* data, std::size_t count);
  /// Closes the file and replaces the old one.
  void commit();

 private:
  [[noreturn]] void fail();
  std::string path_, part_;
  std::FILE* file_;
};

}  // namespace navvy::formats
