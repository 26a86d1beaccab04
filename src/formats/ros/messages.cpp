// SPDX-License-Identifier: Apache-2.0
// Fast-CDR handles alignment and byte order; the order of fields is that of definitions.cpp.
#include "formats/ros/messages.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "core/error.h"
#include "formats/ros/cdr_writer.h"
#include "formats/ros/sensor_messages.h"

namespace navvy::formats::ros {
namespace {

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
  CdrWriter out(static_cast<std::size_t>(map.rect().area()) * layers.size() * sizeof(float));
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
  CdrWriter out(cells.size());
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
  PointCloudMessage cloud{{time_ns, kFrame}, {"x", "y", "z"}, 1, {}, more.empty()};
  for (const map::MapLayer layer : more) cloud.fields.emplace_back(map::info(layer).name);
  for (std::size_t k = 0; k < z.size(); ++k) {
    // A column of unknown height has no point.
    if (z[k] != z[k]) continue;
    const auto nx = static_cast<std::size_t>(map.nx());
    const std::size_t ix = k % nx, iy = k / nx;
    cloud.values.push_back(
        static_cast<float>(map.origin().x() + map.cell() * (static_cast<double>(ix) + 0.5)));
    cloud.values.push_back(
        static_cast<float>(map.origin().y() + map.cell() * (static_cast<double>(iy) + 0.5)));
    cloud.values.push_back(z[k]);
    for (const std::vector<float>& layer : values) cloud.values.push_back(layer[k]);
  }
  return point_cloud(cloud);
}

// Twists count in the axes of the body, as nav_msgs/Odometry defines.
Bytes odometry(const BodyState& body, std::int64_t time_ns) {
  CdrWriter out;
  out.header(time_ns, body.parent) << body.frame;
  // The covariances are zero.
  out.pose(body.X_PB).zeros(36).vector(body.v_B).vector(body.w_B).zeros(36);
  return out.bytes();
}

Bytes joint_state(const JointStates& joints, std::int64_t time_ns) {
  CdrWriter out;
  out.header(time_ns).strings(joints.names).sequence(joints.positions).sequence(joints.velocities);
  return out.sequence(joints.efforts).bytes();
}

// Space for two names of 200 bytes and the padding of each transform.
Bytes tf(const std::vector<Transform>& transforms, std::int64_t time_ns) {
  constexpr std::size_t kMost = 512;
  CdrWriter out(kMost * transforms.size());
  out << static_cast<std::uint32_t>(transforms.size());
  for (const Transform& transform : transforms)
    (out.header(time_ns, transform.parent) << transform.child).pose(transform.X_PC);
  return out.bytes();
}

Bytes string_message(const std::string& text) {
  CdrWriter out;
  out << text;
  return out.bytes();
}

// Elements of one size share a code path.
Bytes multi_array(const std::vector<int>& shape, std::size_t element_bytes,
                  std::span<const std::byte> data) {
  CdrWriter out(data.size());
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

Bytes clock(std::int64_t time_ns) { return CdrWriter().time(time_ns).bytes(); }

}  // namespace navvy::formats::ros
