// SPDX-License-Identifier: Apache-2.0
// Files that ROS 2 plays: MCAP, and the folder of rosbag2 with its SQLite storage.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "formats/ros/messages.h"

namespace navvy::formats::ros {

/// Takes messages in the order of their times; of another order it tells the least and the
/// greatest. Not thread-safe.
class Bag {
 public:
  virtual ~Bag() = default;
  /// Appends a message of `topic`, which always has one kind. @throws FileError naming path and
  /// cause (disk full).
  virtual void write(const std::string& topic, MessageKind kind, std::int64_t time_ns,
                     const Bytes& message) = 0;
  /// Returns true when a message of `topic` was written.
  virtual bool has(const std::string& topic) const = 0;
  /// Writes what readers look for at the end; nothing is written after that. Without it MCAP can be
  /// read as a stream only, and a folder lacks its metadata. @throws FileError.
  virtual void close() = 0;
};

/// One MCAP file, profile ros2: no chunks, no compression; schemas, channels and statistics once
/// more at its end. Replaces `path` at once and grows as messages come. @throws FileError.
std::unique_ptr<Bag> make_mcap(const std::string& path);

/// A rosbag2 folder: `<folder>/<name of the folder>_0.db3` (SQLite, what comes at one time a
/// transaction, which a kill in its middle loses) and, at the end, `<folder>/metadata.yaml` of
/// version 5, which ROS 2 Humble writes.
/// @throws FileError; InputError when the folder holds a file that is no bag's.
std::unique_ptr<Bag> make_bag_folder(const std::string& folder);

}  // namespace navvy::formats::ros
