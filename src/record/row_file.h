// SPDX-License-Identifier: Apache-2.0
// A text file to which rows are appended during a run.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace navvy::record {

/// Appends rows to a text file. Each row is written once. At most about 1 MiB of rows is buffered
/// in memory, so the memory use does not grow with the run.
///
/// Readers find complete rows. Only if the process is killed during a write, the last row may be
/// incomplete: it then has no line end, and readers must ignore it. After an error or at the end of
/// a run, the file ends with a complete row. The folder may be renamed while the file is open.
class RowFile {
 public:
  /// Prepares the file `path` without writing to it. `header` is the first row, without a line end.
  RowFile(std::string path, std::string header);
  /// Closes the file. Buffered rows that were not written with `flush` or `sync` are lost.
  ~RowFile();
  RowFile(const RowFile&) = delete;
  RowFile& operator=(const RowFile&) = delete;

  /// Appends a row, given without a line end, to the buffer. Calls `flush` when the buffer has
  /// reached kMostWaiting bytes.
  /// @throws FileError if that call fails.
  void add(std::string_view row);
  /// Writes the buffered rows to the end of the file. The first call replaces an existing file as a
  /// whole and writes the header first. Returns as soon as the operating system has accepted the
  /// rows.
  /// @throws FileError if writing fails; the file then ends with a complete row, and the next call
  /// writes the buffered rows again.
  void flush();
  /// Writes the buffered rows and waits until they are stored on the disk.
  /// @throws FileError if writing fails.
  void sync();

  /// Continues in a new file at `path`, which gets a copy of all rows; for a folder that was
  /// removed while the file was open.
  /// @throws FileError if the rows cannot be copied; the file then stays where it was.
  void move_to(const std::string& path);

  /// Returns the number of rows that were added, without the header.
  std::uint64_t rows() const { return rows_; }
  /// Returns the size of the rows in the file, including the header [bytes].
  std::uint64_t written() const { return on_disk_; }
  /// Returns the size of the buffered rows, which are not in the file yet [bytes].
  std::size_t waiting() const { return waiting_.size(); }

  /// Size of the buffer [bytes] at which `add` writes the buffered rows to the file.
  static constexpr std::size_t kMostWaiting = std::size_t{1} << 20;

 private:
  /// Path of the file.
  std::string path_;
  /// Buffered rows with their line ends; before the first write, also the header.
  std::string waiting_;
  /// Number of rows that were added, and size of the file [bytes].
  std::uint64_t rows_ = 0, on_disk_ = 0;
  /// File descriptor, open for appending after the first write; -1 before.
  int file_ = -1;
};

}  // namespace navvy::record
