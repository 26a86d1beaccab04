// SPDX-License-Identifier: Apache-2.0
// Files that ROS 2 plays: MCAP, and the folder of rosbag2 with SQLite storage.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "formats/ros/messages.h"

namespace navvy::formats::ros {

/// A bag that is being written. Messages should come in the order of their times; the metadata
/// report the least and the greatest in any case. Not thread-safe.
class Bag {
 public:
  virtual ~Bag() = default;
  /// Appends a message to `topic`, which always has the same kind. `time_ns` is simulated time
  /// [ns]. @throws FileError naming path and cause (disk full).
  virtual void write(const std::string& topic, MessageKind kind, std::int64_t time_ns,
                     const Bytes& message) = 0;
  /// Returns true when a message of `topic` was written.
  virtual bool has(const std::string& topic) const = 0;
  /// Writes the summary that readers look for; nothing may be written afterwards. Without it an
  /// MCAP file can only be read as a stream, and a folder lacks its metadata. @throws FileError.
  virtual void close() = 0;
};

/// Opens an MCAP file with profile ros2, without chunks and compression; schemas, channels and
/// statistics are repeated at its end. Replaces `path` at once and grows with each message. @throws
/// FileError.
std::unique_ptr<Bag> make_mcap(const std::string& path);

/// Opens a rosbag2 folder: `<folder>/<name of the folder>_0.db3` (SQLite) and, at the end,
/// `<folder>/metadata.yaml` of version 5, which ROS 2 Humble writes. The messages of one time form
/// a transaction, which a kill in its middle loses.
/// @throws FileError; InputError when the folder holds a file that does not belong to a bag.
std::unique_ptr<Bag> make_bag_folder(const std::string& folder);

}  // namespace navvy::formats::ros
