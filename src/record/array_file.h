// SPDX-License-Identifier: Apache-2.0
// A NumPy file that grows by one record for each published value of an array.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "sim/array_outputs.h"

namespace navvy::record {

/// Appends the published values of one array to a .npy file.
///
/// `rows = numpy.load(path)` gives a structured array of one record per value: `sequence` (uint64),
/// `time_s` [s], `position_m` (3) and `quaternion_wxyz` (4) of the array's frame in W, and
/// `values`, which has the shape and type of the array. Records come in the order in which they
/// were published.
///
/// Each record is written once and at most 1 MiB of them (or one record) waits in memory, so the
/// cost does not grow with the run. The record count in the file's header is updated after the
/// records themselves: a kill at any moment leaves a file that loads and lacks at most the latest
/// records.
class ArrayFile {
 public:
  /// Size of the waiting records at which `add` writes them to the file [bytes].
  static constexpr std::size_t kMaxWaiting = std::size_t{1} << 20;

  /// Prepares a file for values of `channel`. Writes nothing yet.
  ArrayFile(std::string path, const sim::ArrayChannel& channel);
  /// Closes the file. Records that were not flushed are lost.
  ~ArrayFile();
  ArrayFile(const ArrayFile&) = delete;
  ArrayFile& operator=(const ArrayFile&) = delete;

  /// Adds the present value of the array. Flushes when kMaxWaiting is reached. @throws FileError
  /// then.
  void add(const sim::ArrayView& value);
  /// Appends the waiting records and updates the header; the first call replaces an existing file.
  /// @throws FileError; the waiting records stay and the next call tries again.
  void flush();
  /// Flushes and waits until the disk has the file. @throws FileError.
  void sync();
  /// Number of records added.
  std::uint64_t records() const { return records_; }

 private:
  [[noreturn]] void fail(const char* action, int code) const;
  /// Writes the waiting records, then the header with their number.
  void append();

  std::string path_;
  std::string descr_;    ///< type of a record, as NumPy writes it
  std::string waiting_;  ///< records that are not in the file
  std::size_t record_bytes_ = 0;
  std::size_t header_bytes_ = 0;
  std::uint64_t records_ = 0;  ///< added
  std::uint64_t written_ = 0;  ///< in the file
  int file_ = -1;              ///< open after the first flush
};

}  // namespace navvy::record
