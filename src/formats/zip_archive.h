// SPDX-License-Identifier: Apache-2.0
// Writes a ZIP archive piece by piece and replaces the old file when it is complete.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <list>
#include <string>

struct zip;

namespace navvy::formats {

/// A ZIP archive whose entries are stored without compression and come piece by piece, so that
/// none is held in memory as a whole. The same entries give the same bytes. Before `commit`, and
/// after any error, the old file at the path remains unchanged.
class ZipArchive {
 public:
  /// Function that returns the next bytes of an entry, none at its end.
  using Next = std::function<std::string()>;

  /// Begins an archive that is to be written to `path`. @throws FileError naming path and cause.
  explicit ZipArchive(const std::string& path);
  /// Discards an archive that was not committed.
  ~ZipArchive();
  ZipArchive(const ZipArchive&) = delete;
  ZipArchive& operator=(const ZipArchive&) = delete;

  /// Adds an entry of `size` bytes. `next` is called during `commit`. @throws FileError.
  void add(const std::string& name, std::uint64_t size, Next next);
  /// Adds an entry with this content. @throws FileError.
  void add(const std::string& name, std::string content);
  /// Writes all entries and replaces the old file. @throws FileError, and what `next` of an entry
  /// throws; the old file then remains.
  void commit();

 private:
  /// An entry: its source, and the bytes of it that wait to be read.
  struct Entry;
  /// Throws a FileError for the path.
  [[noreturn]] void fail(const std::string& cause) const;
  /// Copies the next bytes of an entry to `data`; returns their number, -1 after an exception.
  static std::int64_t read(Entry& entry, char* data, std::uint64_t length);
  /// Answers a command of libzip for the entry `user`.
  static std::int64_t serve(void* user, void* data, std::uint64_t length, int command);

  /// Path of the final file (`path_`) and of the temporary file (`part_`).
  std::string path_, part_;
  /// The open archive; null after `commit`.
  ::zip* archive_ = nullptr;
  /// Entries, in a list because libzip keeps their addresses.
  std::list<Entry> entries_;
};

}  // namespace navvy::formats
