// SPDX-License-Identifier: Apache-2.0
// A NumPy file to which records of equal size are appended during a run.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace navvy::record {

/// One field of a record.
struct RecordField {
  std::string name;        ///< name by which NumPy knows it
  std::string type;        ///< element type in NumPy's notation, such as "<f8"
  std::vector<int> shape;  ///< extents; empty: one number
};

/// Appends records of equal size to a .npy file: `numpy.load(path)` returns a structured array.
///
/// Each record is written once. At most about 1 MiB of records, or one record if it is larger, is
/// buffered in memory, so the memory use does not grow with the run. The record count in the file
/// header is updated after the records have been written: a kill at any moment leaves a file that
/// can be loaded and that lacks at most the latest records.
class RecordFile {
 public:
  /// Size of the buffer [bytes] at which `add` writes the buffered records to the file.
  static constexpr std::size_t kMaxWaiting = std::size_t{1} << 20;

  /// Prepares the file `path`, without writing to it. `record_bytes` is the size of a record with
  /// all `fields` [bytes].
  RecordFile(std::string path, const std::vector<RecordField>& fields, std::size_t record_bytes);
  /// Closes the file. Buffered records that were not written with `flush` or `sync` are lost.
  ~RecordFile();
  RecordFile(const RecordFile&) = delete;
  RecordFile& operator=(const RecordFile&) = delete;

  /// Appends a record, the bytes of its fields one after the other in little-endian order, to the
  /// buffer. Calls `flush` when the buffer has reached kMaxWaiting bytes.
  /// @throws Error for a record of another size; FileError if that call fails.
  void add(std::string_view record);
  /// Writes the buffered records to the file and updates the header. The first call replaces an
  /// existing file.
  /// @throws FileError if writing fails; the records stay in the buffer, and the next call writes
  /// them again.
  void flush();
  /// Writes the buffered records and waits until the file is stored on the disk.
  /// @throws FileError if writing fails.
  void sync();
  /// Continues in a new file at `path`, which gets a copy of all records; for a folder that was
  /// removed while the file was open.
  /// @throws FileError if the records cannot be copied; the file then stays where it was.
  void move_to(const std::string& path);
  /// Returns the number of records that were added.
  std::uint64_t records() const { return records_; }

 private:
  /// Throws a FileError for a failed system call; `code` is its errno and `action` the verb for the
  /// message ("open").
  [[noreturn]] void fail(const char* action, int code) const;
  /// Writes the buffered records to the file, then the header with the new record count.
  void append();

  /// Path of the file.
  std::string path_;
  /// Type of a record in NumPy's notation.
  std::string descr_;
  /// Buffered records, which are not in the file yet.
  std::string waiting_;
  /// Size of one record [bytes].
  std::size_t record_bytes_ = 0;
  /// Size of the file header [bytes]; 0 before the first write.
  std::size_t header_bytes_ = 0;
  /// Number of records that were added.
  std::uint64_t records_ = 0;
  /// Number of records in the file.
  std::uint64_t written_ = 0;
  /// File descriptor, open after the first write; -1 before.
  int file_ = -1;
};

/// Appends the bytes of a number to a record.
template <class T>
void put_number(std::string& record, const T& value) {
  record.append(reinterpret_cast<const char*>(&value), sizeof value);
}

}  // namespace navvy::record
