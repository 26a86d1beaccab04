// SPDX-License-Identifier: Apache-2.0
// Fast-CDR handles alignment and byte order; the order of fields is that of definitions.cpp.
#include "formats/ros/messages.h"

#include <fastcdr/Cdr.h>
#include <fastcdr/FastBuffer.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "core/error.h"

namespace navvy::formats::ros {
namespace {

using eprosima::fastcdr::Cdr;
using eprosima::fastcdr::FastBuffer;

/// Serialises one message.
class Writer {
 public:
  /// `payload` is the number of bytes in sequences of numbers.
  explicit Writer(std::size_t payload = 0)
      : cdr_(zeroed(buffer_, payload), Cdr::LITTLE_ENDIANNESS, Cdr::DDS_CDR) {
    cdr_.serialize_encapsulation();
  }
  template <class T>
  Writer& operator<<(const T& value) {
    cdr_ << value;
    return *this;
  }
  /// Appends a sequence: its length, then its numbers in one call.
  template <class T>
  Writer& sequence(const std::vector<T>& values) {
    cdr_ << static_cast<std::uint32_t>(values.size());
    if (!values.empty()) cdr_.serializeArray(values.data(), values.size());
    return *this;
  }
  Writer& strings(const std::vector<std::string>& values) {
    cdr_ << static_cast<std::uint32_t>(values.size());
    for (const std::string& value : values) cdr_ << value;
    return *this;
  }
  Writer& time(std::int64_t ns) {
    // builtin_interfaces/Time: seconds and nanoseconds, here of simulated time.
    return *this << static_cast<std::int32_t>(ns / 1'000'000'000)
                 << static_cast<std::uint32_t>(ns % 1'000'000'000);
  }
  Writer& header(std::int64_t ns) { return time(ns) << std::string(kFrame); }
  Writer& vector(const Vec3& v) { return *this << v.x() << v.y() << v.z(); }
  Writer& pose(const Pose& X) {
    const Eigen::Quaterniond q(X.linear());
    return vector(X.translation()) << q.x() << q.y() << q.z() << q.w();
  }
  Writer& covariance() {
    // Zeros, as the state is exact.
    for (int i = 0; i < 36; ++i) *this << 0.0;
    return *this;
  }
  Bytes bytes() {
    return {buffer_.getBuffer(), buffer_.getBuffer() + cdr_.getSerializedDataLength()};
  }

 private:
  /// Fast-CDR skips padding without writing it: memory that is zero makes equal messages equal byte
  /// for byte.
  static FastBuffer& zeroed(FastBuffer& buffer, std::size_t payload) {
    // Enough for the texts of a message; a longer one only loses the zeros.
    constexpr std::size_t kTexts = 16384;
    if (buffer.reserve(payload + kTexts))
      std::memset(buffer.getBuffer(), 0, buffer.getBufferSize());
    return buffer;
  }

  FastBuffer buffer_;
  Cdr cdr_;
};

// Returns a pose at a place in the plane, without rotation.
Pose at(double x, double y) {
  Pose X = Pose::Identity();
  X.translation() = Vec3(x, y, 0);
  return X;
}

/// Refuses maps whose message would exceed the 32-bit count of bytes.
void require_capacity(const map::TerrainMap& map, std::size_t layers) {
  const double bytes = static_cast<double>(map.rect().area()) * 4 *
                       static_cast<double>(std::max<std::size_t>(layers, 1));
  if (bytes < 2e9) return;
  throw InputError(Fault{Fault::Severity::kError, "", 0, "map message",
                         std::to_string(bytes) + " bytes", "at most 2e9",
                         "ask for fewer layers, or for a GeoTIFF"});
}

}  // namespace

// The conventions of grid_map are those of its own iterators; the test asks at places by its rule.
Bytes grid_map(const map::TerrainMap& map, const std::vector<map::MapLayer>& layers,
               std::int64_t time_ns) {
  require_capacity(map, layers.size());
  const int nx = map.nx(), ny = map.ny();
  const double length_x = nx * map.cell(), length_y = ny * map.cell();
  Writer out(static_cast<std::size_t>(map.rect().area()) * layers.size() * sizeof(float));
  out.header(time_ns) << map.cell() << length_x << length_y;
  out.pose(at(map.origin().x() + length_x / 2, map.origin().y() + length_y / 2));
  std::vector<std::string> names, basic;
  for (const map::MapLayer layer : layers) {
    names.push_back(map::info(layer).name);
    // Users of grid_map take cells without the basic layers as invalid.
    if (layer == map::MapLayer::kElevation) basic.push_back(names.back());
  }
  out.strings(names).strings(basic) << static_cast<std::uint32_t>(layers.size());
  const auto rows = static_cast<std::uint32_t>(nx), columns = static_cast<std::uint32_t>(ny);
  std::vector<float> values(static_cast<std::size_t>(nx) * static_cast<std::size_t>(ny));
  for (const map::MapLayer layer : layers) {
    // The matrix of grid_map has x along its rows and is stored column by column: x runs fastest
    // here too, but both axes run downwards.
    const std::vector<float> ours = map.copy(layer);
    std::reverse_copy(ours.begin(), ours.end(), values.begin());
    // std_msgs/Float32MultiArray with two dimensions; strides count elements.
    out << std::uint32_t{2};
    out << std::string("column_index") << columns << rows * columns;
    out << std::string("row_index") << rows << rows;
    out << std::uint32_t{0};
    out.sequence(values);
  }
  // Both start indices are 0, as the map does not scroll.
  out << std::uint16_t{0} << std::uint16_t{0};
  return out.bytes();
}

// Rounds to whole percent, as nav2 does.
Bytes occupancy_grid(const map::TerrainMap& map, std::int64_t time_ns) {
  require_capacity(map, 1);
  std::vector<std::int8_t> cells;
  for (const float t : map.copy(map::MapLayer::kTraversability))
    cells.push_back(
        t == t ? static_cast<std::int8_t>(std::lround(100 * (1 - std::clamp(t, 0.0f, 1.0f))))
               : std::int8_t{-1});
  Writer out(cells.size());
  // nav_msgs/MapMetaData: time of the map, resolution, width, height and, below, the origin.
  out.header(time_ns).time(time_ns)
      << static_cast<float>(map.cell()) << static_cast<std::uint32_t>(map.nx())
      << static_cast<std::uint32_t>(map.ny());
  out.pose(at(map.origin().x(), map.origin().y())).sequence(cells);
  return out.bytes();
}

// Points are float32, the type that common tools expect in the fields x, y and z.
Bytes point_cloud(const map::TerrainMap& map, const std::vector<map::MapLayer>& layers,
                  std::int64_t time_ns) {
  std::vector<map::MapLayer> more;
  for (const map::MapLayer layer : layers)
    if (layer != map::MapLayer::kElevation) more.push_back(layer);
  require_capacity(map, 3 + more.size());
  const std::vector<float> z = map.copy(map::MapLayer::kElevation);
  std::vector<std::vector<float>> values;
  values.reserve(more.size());
  for (const map::MapLayer layer : more) values.push_back(map.copy(layer));
  std::vector<std::uint8_t> data;
  const auto put = [&](float value) {
    std::uint8_t bytes[4];
    std::memcpy(bytes, &value, 4);
    data.insert(data.end(), bytes, bytes + 4);
  };
  std::uint32_t points = 0;
  for (std::size_t k = 0; k < z.size(); ++k) {
    // A column of unknown height has no point.
    if (z[k] != z[k]) continue;
    const auto nx = static_cast<std::size_t>(map.nx());
    const std::size_t ix = k % nx, iy = k / nx;
    put(static_cast<float>(map.origin().x() + map.cell() * (static_cast<double>(ix) + 0.5)));
    put(static_cast<float>(map.origin().y() + map.cell() * (static_cast<double>(iy) + 0.5)));
    put(z[k]);
    for (const std::vector<float>& layer : values) put(layer[k]);
    ++points;
  }
  const auto step = static_cast<std::uint32_t>(4 * (3 + more.size()));
  Writer out(data.size());
  // Height 1 and width `points`: the cloud has no order in rows.
  out.header(time_ns) << std::uint32_t{1} << points << static_cast<std::uint32_t>(3 + more.size());
  std::uint32_t offset = 0;
  const auto field = [&](const std::string& name) {
    // 7 stands for FLOAT32.
    out << name << offset << std::uint8_t{7} << std::uint32_t{1};
    offset += 4;
  };
  for (const char* axis : {"x", "y", "z"}) field(axis);
  for (const map::MapLayer layer : more) field(map::info(layer).name);
  // A cloud is dense when no field of any point is invalid.
  out << false << step << step * points;
  out.sequence(data) << more.empty();
  return out.bytes();
}

// Twists count in the axes of the body, as nav_msgs/Odometry defines.
Bytes odometry(const BodyState& body, std::int64_t time_ns) {
  const Mat3 R_BW = body.X_WB.linear().transpose();
  Writer out;
  out.header(time_ns) << body.frame;
  out.pose(body.X_WB).covariance().vector(R_BW * body.v_W).vector(R_BW * body.w_W).covariance();
  return out.bytes();
}

Bytes joint_state(const JointStates& joints, std::int64_t time_ns) {
  Writer out;
  out.header(time_ns).strings(joints.names).sequence(joints.positions).sequence(joints.velocities);
  return out.sequence(joints.efforts).bytes();
}

// All transforms have W as parent, so that readers need no chain.
Bytes tf(const std::vector<BodyState>& bodies, std::int64_t time_ns) {
  Writer out;
  out << static_cast<std::uint32_t>(bodies.size());
  for (const BodyState& body : bodies) (out.header(time_ns) << body.frame).pose(body.X_WB);
  return out.bytes();
}

Bytes string_message(const std::string& text) {
  Writer out;
  out << text;
  return out.bytes();
}

// Elements of one size share a code path.
Bytes multi_array(const std::vector<int>& shape, std::size_t element_bytes,
                  std::span<const std::byte> data) {
  Writer out(data.size());
  out << static_cast<std::uint32_t>(shape.size());
  std::uint32_t stride = 1;
  for (const int size : shape) stride *= static_cast<std::uint32_t>(size);
  for (std::size_t i = 0; i < shape.size(); ++i) {
    // A stride counts the elements of its dimension and all faster ones.
    const auto size = static_cast<std::uint32_t>(shape[i]);
    out << "dim" + std::to_string(i) << size << stride;
    stride /= size;
  }
  // No elements stand before the data.
  out << std::uint32_t{0};
  const auto put = [&]<class T>(T) {
    std::vector<T> values(data.size() / sizeof(T));
    std::memcpy(values.data(), data.data(), values.size() * sizeof(T));
    out.sequence(values);
  };
  // CDR aligns by size alone: integers and floats of one size have the same bytes.
  if (element_bytes == 1) put(std::uint8_t{});
  if (element_bytes == 2) put(std::uint16_t{});
  if (element_bytes == 4) put(std::uint32_t{});
  if (element_bytes == 8) put(std::uint64_t{});
  return out.bytes();
}

Bytes clock(std::int64_t time_ns) { return Writer().time(time_ns).bytes(); }

}  // namespace navvy::formats::ros
