// SPDX-License-Identifier: Apache-2.0
// Writes a large file piece by piece and replaces the old file when it is complete.
#pragma once

#include <cstddef>
#include <cstdio>
#include <string>

namespace navvy::formats {

/// A file that is written under a temporary name next to `path`, and replaces `path` when it is
/// complete. Before that, and after any error, the old file at `path` remains unchanged.
class PartFile {
 public:
  /// Creates the temporary file. @throws FileError naming path and cause, also if `path` exists and
  /// is not a regular file.
  explicit PartFile(const std::string& path);
  /// Removes the temporary file if it was not committed.
  ~PartFile();
  PartFile(const PartFile&) = delete;
  PartFile& operator=(const PartFile&) = delete;

  /// Appends `count` bytes of `data`. @throws FileError.
  void write(const void* data, std::size_t count);
  /// Closes the temporary file and renames it to the final path. @throws FileError; the old file
  /// then remains.
  void commit();

 private:
  /// Throws a FileError for the path, with the cause in errno.
  [[noreturn]] void fail();
  /// Path of the final file (`path_`) and of the temporary file (`part_`).
  std::string path_, part_;
  /// The open temporary file; null after `commit`.
  std::FILE* file_;
};

}  // namespace navvy::formats
