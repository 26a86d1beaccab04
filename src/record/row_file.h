// SPDX-License-Identifier: Apache-2.0
// A text file that grows by rows for as long as a run lasts.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace navvy::record {

/// Appends rows to a file: each is written once, so the bytes written are those of the file, and
/// what is in memory is what came since the last flush, 1 MiB at most, however long the run is.
///
/// A reader finds whole rows, but for one moment: a kill in the middle of an append may leave the
/// last row cut short. It has no line end then, and whoever reads the file leaves it out; Navvy
/// itself reads no such file. Whatever else happens, an error or the end of the run, the file ends
/// with a whole row. It stays with its file when the folder is renamed.
class RowFile {
 public:
  /// Writes nothing yet. `header` is the first row, without its line end.
  RowFile(std::string path, std::string header);
  /// What waits is lost unless it was flushed: a destructor cannot tell of a full disk.
  ~RowFile();
  RowFile(const RowFile&) = delete;
  RowFile& operator=(const RowFile&) = delete;

  /// One row without its line end. Flushes by itself when 1 MiB waits. @throws FileError then.
  void add(std::string_view row);
  /// Appends what waits; the first time it replaces the file whole, header first. Returns when the
  /// system has it.
  /// @throws FileError; the file then ends with the last whole row it had, and what waits is tried
  /// again by the next flush.
  void flush();
  /// Flushes, and waits until the disk has it. @throws FileError.
  void sync();

  std::uint64_t rows() const { return rows_; }             ///< added, without the header
  std::uint64_t written() const { return on_disk_; }       ///< [bytes] of the file, header and all
  std::size_t waiting() const { return waiting_.size(); }  ///< [bytes] not in the file yet

  /// [bytes] at which it flushes by itself.
  static constexpr std::size_t kMostWaiting = std::size_t{1} << 20;

 private:
  std::string path_;
  std::string waiting_;
  std::uint64_t rows_ = 0, on_disk_ = 0;
  int file_ = -1;  ///< open for appending once there is a file
};

}  // namespace navvy::record
