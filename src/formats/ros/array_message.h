// SPDX-License-Identifier: Apache-2.0
// Arrays of a running simulation, such as scans and grids, as messages of a ROS bag.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "formats/ros/bag.h"

namespace navvy::formats::ros {

/// Type of the elements of an array.
enum class ArrayElement { kUint8, kUint16, kInt32, kFloat32, kFloat64 };

/// One sample of an array output.
struct ArrayMessage {
  /// Name of the array, which is unique in the bag, such as "excavator/height_grid".
  std::string name;
  /// Unit of all elements, such as "m" or "1".
  std::string unit;
  /// One-line description for the user.
  std::string meaning;
  /// Name of the coordinate frame that the elements refer to: "world", "<machine>/<link>", or a
  /// name of the array's own.
  std::string frame;
  /// Type of the elements.
  ArrayElement element = ArrayElement::kFloat32;
  /// Size of each dimension, slowest first, such as {rows, columns}.
  std::vector<int> shape;
  /// Simulated time of the sample [s].
  double time = 0;
  /// Pose of the array's frame F in the world frame W, at the time of the sample.
  Pose X_WF = Pose::Identity();
  /// Elements in row-major order and in the byte order of this machine. Must remain valid during
  /// `write_array` only.
  std::span<const std::byte> data;
  /// True if the bag has the frame in its tree already, as that of a link: it must not get a second
  /// parent.
  bool frame_is_known = false;
};

/// Appends a sample of an array to `bag`:
/// - to `/<name>`, a std_msgs UInt8-, UInt16-, Int32-, Float32- or Float64MultiArray with one
///   dimension per entry of the shape, stamped with the time of the sample;
/// - before the first sample, to `/<name>/description`, a latched std_msgs/String with a JSON
///   object of name, unit, meaning, frame, type and shape;
/// - to `/tf`, the pose of the array's frame as a child of "map", unless it is the world frame or
///   known.
///
/// @throws Error if the number of bytes does not match the shape; FileError.
void write_array(Bag& bag, const ArrayMessage& array);

}  // namespace navvy::formats::ros
