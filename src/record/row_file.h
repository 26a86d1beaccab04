// SPDX-License-Identifier: Apache-2.0
// A text file that grows by rows for as long as a run lasts.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace navvy::record {

/// Appends rows to a text file. Each row is written once, and at most 1 MiB of them waits in
/// memory, so the cost does not grow with the run.
///
/// Readers find whole rows. Only a kill during an append may leave a last row that is cut short and
/// lacks its line end; readers must leave it out. After an error or at the end of a run the file
/// ends with a whole row. Renaming the folder does no harm.
class RowFile {
 public:
  /// Prepares the file and writes nothing yet. `header` is the first row, without its line end.
  RowFile(std::string path, std::string header);
  /// Closes the file. Rows that were not flushed are lost.
  ~RowFile();
  RowFile(const RowFile&) = delete;
  RowFile& operator=(const RowFile&) = delete;

  /// Adds a row, given without its line end. Flushes when kMostWaiting is reached. @throws
  /// FileError then.
  void add(std::string_view row);
  /// Appends the waiting rows. The first call replaces an existing file as a whole, header first.
  /// Returns when the operating system has the rows. @throws FileError; the file then ends with a
  /// whole row, and the next call tries the waiting rows again.
  void flush();
  /// Flushes and waits until the disk has the rows. @throws FileError.
  void sync();

  /// Returns the number of rows added, without the header.
  std::uint64_t rows() const { return rows_; }
  /// Returns the size of the file with its header [bytes].
  std::uint64_t written() const { return on_disk_; }
  /// Returns the size of the rows that are not in the file yet [bytes].
  std::size_t waiting() const { return waiting_.size(); }

  /// Size of the waiting rows at which `add` flushes [bytes].
  static constexpr std::size_t kMostWaiting = std::size_t{1} << 20;

 private:
  std::string path_;
  std::string waiting_;
  std::uint64_t rows_ = 0, on_disk_ = 0;
  int file_ = -1;  ///< open for appending after the first flush
};

}  // namespace navvy::record
