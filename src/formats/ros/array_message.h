// SPDX-License-Identifier: Apache-2.0
// Typed arrays of a running world, such as scans and grids, as messages of a bag.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "formats/ros/bag.h"

namespace navvy::formats::ros {

/// Type of one element.
enum class ArrayElement { kUint8, kUint16, kInt32, kFloat32, kFloat64 };

/// One sample of an array, whoever made it. The data are only read during `write_array`.
struct ArrayMessage {
  /// Unique in the bag, e.g. "excavator/height_grid".
  std::string name;
  /// Unit of every element: "m", "1".
  std::string unit;
  /// One line for people.
  std::string meaning;
  /// Frame F that the numbers count in: "world" for W, "<machine>/<link>", or one of its own.
  std::string frame;
  /// Type of the elements.
  ArrayElement element = ArrayElement::kFloat32;
  /// Row-major, slowest first: {rows, columns}.
  std::vector<int> shape;
  /// Simulated time of the sample [s].
  double time = 0;
  /// Pose of the frame in W at that time.
  Pose X_WF = Pose::Identity();
  /// The elements in the byte order of this machine.
  std::span<const std::byte> data;
};

/// Appends a sample to a bag:
/// - `/<name>` as std_msgs UInt8-, UInt16-, Int32-, Float32- or Float64MultiArray with one
///   dimension per entry of the shape, stamped with the time of the sample;
/// - before the first sample `/<name>/description` (std_msgs/String), a JSON object with name,
///   unit, meaning, frame, type and shape;
/// - `/tf` with the frame as a child of "map", unless the frame is W.
///
/// @throws Error when the data do not fill the shape; FileError.
void write_array(Bag& bag, const ArrayMessage& array);

}  // namespace navvy::formats::ros
