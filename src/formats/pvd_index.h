// SPDX-License-Identifier: Apache-2.0
// Index of files over time (PVD), by which ParaView shows them as one animation.
#pragma once

#include <cstdint>
#include <string>

namespace navvy::formats {

/// A PVD file to which entries are added during a run. Each `add` writes only its entry and the end
/// of the document, so the cost of a long run is proportional to its entries. The file is complete
/// after every call.
class PvdIndex {
 public:
  /// Prepares the file `path` without writing to it.
  explicit PvdIndex(std::string path);
  ~PvdIndex();
  PvdIndex(const PvdIndex&) = delete;
  PvdIndex& operator=(const PvdIndex&) = delete;

  /// Adds an entry: the file `name`, relative to the folder of the index, holds the state at `time`
  /// [s]. The first call replaces an existing file. @throws FileError naming path and cause.
  void add(double time, const std::string& name);

 private:
  /// Path of the index.
  std::string path_;
  /// Position of the end of the document in the file [bytes].
  std::uint64_t end_ = 0;
  /// Descriptor of the open file; -1 before the first entry.
  int file_ = -1;
};

}  // namespace navvy::formats
