// SPDX-License-Identifier: Apache-2.0
// Bags that ROS 2 can play: MCAP files, and rosbag2 folders with SQLite storage.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "formats/ros/messages.h"

namespace navvy::formats::ros {

/// A ROS bag that is being written. Messages should be added in the order of their times; the
/// metadata contain the earliest and the latest time in any case. Not thread-safe.
class Bag {
 public:
  /// Allows deletion through a base class pointer. Does not close the bag.
  virtual ~Bag() = default;
  /// Appends a message to `topic`, whose messages must all have the same type. `time_ns` is the
  /// simulated time [ns]. @throws FileError naming path and cause, such as a full disk.
  void write(const std::string& topic, MessageKind kind, std::int64_t time_ns,
             const Bytes& message) {
    add({topic, kind, false}, time_ns, message);
  }
  /// Appends a message as `write` does to a topic of latched messages: players offer it with the
  /// durability "transient local", so that late subscribers receive it too.
  void write_latched(const std::string& topic, MessageKind kind, std::int64_t time_ns,
                     const Bytes& message) {
    add({topic, kind, true}, time_ns, message);
  }
  /// Returns true if the bag contains a message of `topic`.
  virtual bool has(const std::string& topic) const = 0;
  /// Completes the bag. Nothing may be written afterwards. A bag that was not closed is incomplete:
  /// an MCAP file can then only be read as a stream, and a folder has no metadata. @throws
  /// FileError.
  virtual void close() = 0;

 protected:
  /// Topic of a message.
  struct Topic {
    /// Name of the topic.
    const std::string& name;
    /// Type of its messages.
    MessageKind kind;
    /// True if its messages are latched.
    bool latched;
    /// Returns the quality of service that players offer, in the YAML of rosbag2; empty for their
    /// default.
    std::string offered_qos() const;
  };

 private:
  /// Appends a message. @throws FileError naming path and cause.
  virtual void add(const Topic& topic, std::int64_t time_ns, const Bytes& message) = 0;
};

/// Creates an MCAP file with the profile ros2, without chunks and without compression. Schemas,
/// channels and statistics are repeated at its end. Replaces an existing file at once. @throws
/// FileError.
std::unique_ptr<Bag> make_mcap(const std::string& path);

/// Creates a rosbag2 folder with the files `<folder>/<name of the folder>_0.db3` (SQLite) and, when
/// it is closed, `<folder>/metadata.yaml` of version 5, as ROS 2 Humble writes it. Messages with
/// the same time form one transaction; if the process is killed during a transaction, its messages
/// are lost.
/// @throws FileError; InputError if the folder contains a file that does not belong to a bag.
std::unique_ptr<Bag> make_bag_folder(const std::string& folder);

}  // namespace navvy::formats::ros
