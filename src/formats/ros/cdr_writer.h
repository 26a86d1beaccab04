// SPDX-License-Identifier: Apache-2.0
// Serialises ROS messages field by field. Fast-CDR handles alignment and byte order; sources of
// this folder give the fields in the order of definitions.cpp.
#pragma once

#include <fastcdr/Cdr.h>
#include <fastcdr/FastBuffer.h>

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <vector>

#include "core/math.h"
#include "formats/ros/messages.h"

namespace navvy::formats::ros {

/// Serialises one message. Each function appends a field or a group of fields and returns the
/// writer, so that calls can be chained.
class CdrWriter {
 public:
  /// Starts a message. `payload` is the number of bytes of its sequences and of texts beyond 16
  /// KiB.
  explicit CdrWriter(std::size_t payload = 0)
      : cdr_(zeroed(buffer_, payload), eprosima::fastcdr::Cdr::LITTLE_ENDIANNESS,
             eprosima::fastcdr::Cdr::DDS_CDR) {
    cdr_.serialize_encapsulation();
  }
  /// Appends a number, a truth value or a text.
  template <class T>
  CdrWriter& operator<<(const T& value) {
    cdr_ << value;
    return *this;
  }
  /// Appends a sequence: its length, then its numbers in one call.
  template <class T>
  CdrWriter& sequence(std::span<const T> values) {
    cdr_ << static_cast<std::uint32_t>(values.size());
    if (!values.empty()) cdr_.serializeArray(values.data(), values.size());
    return *this;
  }
  /// Appends a sequence: its length, then its numbers in one call.
  template <class T>
  CdrWriter& sequence(const std::vector<T>& values) {
    return sequence(std::span<const T>(values));
  }
  /// Appends a sequence of texts.
  CdrWriter& strings(const std::vector<std::string>& values) {
    cdr_ << static_cast<std::uint32_t>(values.size());
    for (const std::string& value : values) cdr_ << value;
    return *this;
  }
  /// Appends a builtin_interfaces/Time: seconds and nanoseconds, here of simulated time.
  CdrWriter& time(std::int64_t ns) {
    return *this << static_cast<std::int32_t>(ns / 1'000'000'000)
                 << static_cast<std::uint32_t>(ns % 1'000'000'000);
  }
  /// Appends a std_msgs/Header with the simulated time `ns` [ns] and the name of a frame.
  CdrWriter& header(std::int64_t ns, const std::string& frame = kFrame) {
    return time(ns) << frame;
  }
  /// Appends a geometry_msgs/Point or Vector3.
  CdrWriter& vector(const Vec3& v) { return *this << v.x() << v.y() << v.z(); }
  /// Appends a geometry_msgs/Quaternion.
  CdrWriter& rotation(const Mat3& R) {
    const Eigen::Quaterniond q(R);
    return *this << q.x() << q.y() << q.z() << q.w();
  }
  /// Appends a geometry_msgs/Pose or Transform.
  CdrWriter& pose(const Pose& X) { return vector(X.translation()).rotation(X.linear()); }
  /// Appends a 3 x 3 matrix row by row, as an array of fixed length.
  CdrWriter& matrix(const Mat3& m) {
    for (int row = 0; row < 3; ++row)
      for (int column = 0; column < 3; ++column) *this << m(row, column);
    return *this;
  }
  /// Appends `count` zeros as an array of fixed length.
  CdrWriter& zeros(int count) {
    for (int i = 0; i < count; ++i) *this << 0.0;
    return *this;
  }
  /// Returns the encapsulation header and all fields.
  Bytes bytes() {
    return {buffer_.getBuffer(), buffer_.getBuffer() + cdr_.getSerializedDataLength()};
  }

 private:
  /// Fast-CDR skips padding without writing it: memory that is zero makes equal messages equal byte
  /// for byte.
  static eprosima::fastcdr::FastBuffer& zeroed(eprosima::fastcdr::FastBuffer& buffer,
                                               std::size_t payload) {
    // Enough for the texts of a message; a longer one only loses the zeros.
    constexpr std::size_t kTexts = 16384;
    if (buffer.reserve(payload + kTexts))
      std::memset(buffer.getBuffer(), 0, buffer.getBufferSize());
    return buffer;
  }

  /// Memory of the message.
  eprosima::fastcdr::FastBuffer buffer_;
  /// Writes into `buffer_`.
  eprosima::fastcdr::Cdr cdr_;
};

}  // namespace navvy::formats::ros
