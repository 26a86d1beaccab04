// SPDX-License-Identifier: Apache-2.0
// Bags read by the independent Python packages `mcap` and `rosbags` (`./dev readers`); a grid map
// is queried by the rule of its users. Not square, with a hole and a marked corner.
#include "formats/ros/array_message.h"
#include "formats/ros/streams.h"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <Eigen/Geometry>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <span>

#include "core/error.h"
#include "core/file.h"
#include "folder.h"
#include "formats/formats.h"
#include "heightfield/maps.h"
#include "map/grounds.h"
#include "paths.h"

namespace navvy::formats {
namespace {

using nlohmann::json;

constexpr int kNx = 12, kNy = 8;

bool hole(int ix, int iy) { return ix == 3 && iy == 5; }
float elevation(int ix, int iy) {
  return hole(ix, iy) ? map::kUnknown : static_cast<float>(0.1 * ix - 0.03 * iy * ix + iy);
}
float good(int ix, int iy) {
  return hole(ix, iy) ? map::kUnknown : ix == kNx - 1 && iy == 0 ? 0.0f : 0.01f * (ix + 10);
}

map::TerrainMap example() {
  std::vector<float> z, t;
  for (int iy = 0; iy < kNy; ++iy)
    for (int ix = 0; ix < kNx; ++ix) z.push_back(elevation(ix, iy)), t.push_back(good(ix, iy));
  return map::TerrainMap(map::testing::setup(kNx, kNy), 12.5, 3)
      .with(map::MapLayer::kElevation, z)
      .with(map::MapLayer::kTraversability, t);
}
const std::vector<map::MapLayer> kTwo = {map::MapLayer::kElevation, map::MapLayer::kTraversability};

/// Path of the readers' Python; empty if it is not installed.
std::string readers() {
  const std::string python = navvy::source_dir() + "/build/readers/bin/python3";
  return std::filesystem::exists(python) ? python : "";
}

// Prints the contents of a bag by topic: type, times, and the last message in a form that tests can
// check.
const char* const kRead = R"(
import json, math, sys
from pathlib import Path
from rosbags.rosbag2.metadata import parse_qos
from rosbags.typesys import Stores, get_typestore, get_types_from_msg
store = get_typestore(Stores.EMPTY)
out, path = {}, Path(sys.argv[1])
def learn(text, kind):
    store.register({k: v for k, v in get_types_from_msg(text, kind).items() if k not in store.fielddefs})
def durability(qos):
    return qos[0].durability.name if qos else ''
def show(topic, kind, ns, raw, qos):
    m = store.deserialize_cdr(raw, kind)
    t = out.setdefault(topic, {'type': kind, 'times': []})
    t['durability'] = durability(qos)
    t['times'].append(ns)
    plain = lambda v: None if isinstance(v, float) and not math.isfinite(v) else v
    if kind.endswith('GridMap'):
        r, rows, p = m.info.resolution, m.data[0].layout.dim[1].size, m.info.pose.position
        cols = m.data[0].layout.dim[0].size
        t['dims'] = [[d.label, d.size, d.stride] for d in m.data[0].layout.dim]
        t['layers'], t['basic'], t['frame'] = list(m.layers), list(m.basic_layers), m.header.frame_id
        t['stamp'] = [m.header.stamp.sec, m.header.stamp.nanosec]
        top, left = p.x + m.info.length_x / 2, p.y + m.info.length_y / 2
        x0, y0 = float(sys.argv[2]), float(sys.argv[3])
        for name, data in zip(m.layers, m.data):
            at = lambda x, y: plain(float(data.data[int((left - y) / r) * rows + int((top - x) / r)]))
            t[name] = [at(x0 + r * (i + .5), y0 + r * (j + .5)) for j in range(cols) for i in range(rows)]
    if kind.endswith('OccupancyGrid'):
        t['size'] = [m.info.width, m.info.height, m.info.resolution, m.info.origin.position.x, m.info.origin.position.y]
        t['data'] = [int(v) for v in m.data]
    if kind.endswith('PointCloud2'):
        import struct
        n = m.point_step // 4
        t['fields'] = [[f.name, f.offset, f.datatype, f.count] for f in m.fields]
        b = bytes(m.data)
        t['points'] = [struct.unpack_from('<%df' % n, b, i * m.point_step) for i in range(m.width * m.height)]
        assert m.row_step == m.point_step * m.width == len(b)
    if kind.endswith('Odometry'):
        p, q, v, w = m.pose.pose.position, m.pose.pose.orientation, m.twist.twist.linear, m.twist.twist.angular
        t['state'] = [p.x, p.y, p.z, q.x, q.y, q.z, q.w, v.x, v.y, v.z, w.x, w.y, w.z]
        t['child'], t['parent'] = m.child_frame_id, m.header.frame_id
    if kind.endswith('JointState'):
        t['joints'] = [list(m.name), list(m.position), list(m.velocity), list(m.effort)]
    if kind.endswith('TFMessage'):
        t['frames'] = [[f.header.frame_id, f.child_frame_id] for f in m.transforms]
    if kind.endswith('MultiArray'):
        t['layout'] = [[d.label, d.size, d.stride] for d in m.layout.dim] + [m.layout.data_offset]
        t['data'] = [float(v) for v in m.data]
    if kind.endswith('String'): t['text'] = json.loads(m.data)
    if kind.endswith('Clock'): t['clock'] = [m.clock.sec, m.clock.nanosec]
types = {}
if path.suffix == '.mcap':
    from mcap.reader import make_reader
    reader = make_reader(open(path, 'rb'))
    summary = reader.get_summary()
    out['statistics'] = [summary.statistics.message_count, len(summary.channels), len(summary.schemas)]
    assert reader.get_header().profile == 'ros2'
    for schema, channel, message in reader.iter_messages():
        assert schema.encoding == 'ros2msg' and channel.message_encoding == 'cdr'
        learn(schema.data.decode(), schema.name)
        qos = parse_qos(channel.metadata.get('offered_qos_profiles', ''))
        show(channel.topic, schema.name, message.log_time, message.data, qos)
else:
    from rosbags.rosbag2 import Reader
    for kind, text in json.load(open(sys.argv[4])).items():
        learn(text, kind)
    with Reader(path) as reader:
        out['statistics'] = [reader.message_count, len(reader.topics), reader.duration]
        for connection, ns, raw in reader.messages():
            qos = connection.ext.offered_qos_profiles
            show(connection.topic, connection.msgtype, ns, raw, qos)
print(json.dumps(out))
)";

json read(const test::Folder& folder, const std::string& bag) {
  // The folder format stores types by name only.
  json types;
  for (int i = 0; i < ros::kMessageKinds; ++i)
    types[ros::type_name(static_cast<ros::MessageKind>(i))] =
        ros::definition(static_cast<ros::MessageKind>(i));
  heightfield::testing::write_text(folder / "types.json", types.dump());
  heightfield::testing::write_text(folder / "read.py", kRead);
  const Vec2 origin = map::testing::setup().origin;
  const std::string text = heightfield::testing::output_of(
      "'" + readers() + "' '" + folder / "read.py" + "' '" + bag + "' " +
      std::to_string(origin.x()) + " " + std::to_string(origin.y()) + " '" + folder / "types.json" +
      "'");
  return json::parse(text, nullptr, false);
}

void expect_map(const json& bag) {
  ASSERT_FALSE(bag.is_discarded()) << "the reader failed";
  const json& grid = bag.at("/terrain/grid_map");
  EXPECT_EQ(grid.at("type"), "grid_map_msgs/msg/GridMap");
  EXPECT_EQ(grid.at("stamp"), json({12, 500000000}));
  EXPECT_EQ(grid.at("times"), json({12500000000}));
  EXPECT_EQ(grid.at("layers"), json({"elevation", "traversability"}));
  EXPECT_EQ(grid.at("basic"), json({"elevation"}));
  EXPECT_EQ(grid.at("frame"), "map");
  EXPECT_EQ(grid.at("dims"), json({{"column_index", kNy, kNx * kNy}, {"row_index", kNx, kNx}}));
  const json& cells = bag.at("/terrain/occupancy");
  EXPECT_EQ(cells.at("size")[0], kNx);
  EXPECT_EQ(cells.at("size")[1], kNy);
  EXPECT_NEAR(cells.at("size")[3].get<double>(), -3.3, 1e-12);
  const json& cloud = bag.at("/terrain/points");
  EXPECT_EQ(cloud.at("fields"),
            json({{"x", 0, 7, 1}, {"y", 4, 7, 1}, {"z", 8, 7, 1}, {"traversability", 12, 7, 1}}));
  ASSERT_EQ(cloud.at("points").size(), kNx * kNy - 1u);
  std::size_t k = 0, point = 0;
  for (int iy = 0; iy < kNy; ++iy)
    for (int ix = 0; ix < kNx; ++ix, ++k) {
      SCOPED_TRACE(std::to_string(ix) + " " + std::to_string(iy));
      if (hole(ix, iy)) {
        EXPECT_TRUE(grid.at("elevation")[k].is_null());
        EXPECT_EQ(cells.at("data")[k], -1);
        continue;
      }
      EXPECT_EQ(grid.at("elevation")[k].get<float>(), elevation(ix, iy));
      EXPECT_EQ(grid.at("traversability")[k].get<float>(), good(ix, iy));
      EXPECT_NEAR(cells.at("data")[k].get<int>(), 100 * (1 - good(ix, iy)), 0.5001);
      const json& p = cloud.at("points")[point++];
      const Vec2 at = map::testing::centre(map::testing::setup(kNx, kNy), ix, iy);
      EXPECT_EQ(p[0].get<float>(), static_cast<float>(at.x()));
      EXPECT_EQ(p[1].get<float>(), static_cast<float>(at.y()));
      EXPECT_EQ(p[2].get<float>(), elevation(ix, iy));
      EXPECT_EQ(p[3].get<float>(), good(ix, iy));
    }
  EXPECT_EQ(bag.at("/clock").at("clock"), json({12, 500000000}));
}

TEST(Mcap, MapIsReadByOthers) {
  if (readers().empty()) GTEST_SKIP() << "the readers mcap and rosbags are missing: ./dev readers";
  const test::Folder folder;
  write_map("mcap", example(), kTwo, folder / "map.mcap");
  const json bag = read(folder, folder / "map.mcap");
  expect_map(bag);
  EXPECT_EQ(bag.at("statistics"), json({4, 4, 4}));
}

TEST(RosBag, MapIsReadByOthers) {
  if (readers().empty()) GTEST_SKIP() << "the readers mcap and rosbags are missing: ./dev readers";
  const test::Folder folder;
  write_map("bag", example(), kTwo, folder / "bag");
  const json bag = read(folder, folder / "bag");
  expect_map(bag);
  EXPECT_EQ(bag.at("statistics")[0], 4);
  // A second bag replaces it; a foreign folder is left unchanged.
  write_map("bag", example(), kTwo, folder / "bag");
  EXPECT_EQ(read(folder, folder / "bag").at("statistics")[0], 4);
  heightfield::testing::write_text(folder / "bag/mine.txt", "x");
  EXPECT_THROW(write_map("bag", example(), kTwo, folder / "bag"), InputError);
}

/// A body that was turned to the left, with a velocity in its own axes.
ros::BodyState body() {
  ros::BodyState out;
  out.parent = "ew/odom";
  out.frame = "ew/base_link";
  out.X_PB = Pose(Eigen::AngleAxisd(kPi / 2, Vec3::UnitZ()));
  out.X_PB.translation() = Vec3(1, 2, 3);
  out.v_B = Vec3(0, -0.5, 0.1);
  out.w_B = Vec3(0, 0, 0.25);
  return out;
}

void write_bodies(ros::Bag& bag) {
  for (const std::int64_t ns : {1'000'000'000LL, 2'500'000'001LL}) {
    bag.write("/clock", ros::MessageKind::kClock, ns, ros::clock(ns));
    bag.write("/ew/odom", ros::MessageKind::kOdometry, ns, ros::odometry(body(), ns));
    bag.write("/ew/joint_states", ros::MessageKind::kJointState, ns,
              ros::joint_state({{"boom", "arm"}, {0.5, -1}, {0, 2}, {7, 8}}, ns));
    bag.write("/tf", ros::MessageKind::kTf, ns,
              ros::tf({{"map", "ew/odom"}, {"ew/odom", "ew/base_link", body().X_PB}}, ns));
  }
  ros::write_fixed(bag, {{"ew/base_link", "ew/chassis"}}, 2'500'000'001LL);
  ros::write_description(bag, "ew", "\"<robot/>\"", 2'500'000'001LL);
  bag.close();
}

void expect_bodies(const json& bag) {
  ASSERT_FALSE(bag.is_discarded()) << "the reader failed";
  const double h = std::sqrt(0.5);
  const std::vector<double> state = {1, 2, 3, 0, 0, h, h, 0, -0.5, 0.1, 0, 0, 0.25};
  for (std::size_t i = 0; i < state.size(); ++i)
    EXPECT_NEAR(bag.at("/ew/odom").at("state")[i].get<double>(), state[i], 1e-12) << i;
  EXPECT_EQ(bag.at("/ew/odom").at("child"), "ew/base_link");
  EXPECT_EQ(bag.at("/ew/odom").at("parent"), "ew/odom");
  EXPECT_EQ(bag.at("/ew/joint_states").at("joints"),
            json({{"boom", "arm"}, {0.5, -1.0}, {0.0, 2.0}, {7.0, 8.0}}));
  EXPECT_EQ(bag.at("/tf").at("frames"), json::array({json::array({"map", "ew/odom"}),
                                                     json::array({"ew/odom", "ew/base_link"})}));
  EXPECT_EQ(bag.at("/tf_static").at("frames"),
            json::array({json::array({"ew/base_link", "ew/chassis"})}));
  EXPECT_EQ(bag.at("/ew/robot_description").at("text"), "<robot/>");
  // Late subscribers get what is written once.
  for (const char* topic : {"/tf_static", "/ew/robot_description"})
    EXPECT_EQ(bag.at(topic).at("durability"), "TRANSIENT_LOCAL") << topic;
  for (const char* topic : {"/tf", "/clock"})
    EXPECT_EQ(bag.at(topic).at("durability"), "") << topic;
  EXPECT_EQ(bag.at("/clock").at("clock"), json({2, 500000001}));
  EXPECT_EQ(bag.at("/clock").at("times"), json({1000000000, 2500000001}));
}

TEST(Mcap, MovingBodiesAreReadByOthers) {
  if (readers().empty()) GTEST_SKIP() << "the readers mcap and rosbags are missing: ./dev readers";
  const test::Folder folder;
  write_bodies(*ros::make_mcap(folder / "run.mcap"));
  expect_bodies(read(folder, folder / "run.mcap"));
}

TEST(RosBag, MovingBodiesAreReadByOthers) {
  if (readers().empty()) GTEST_SKIP() << "the readers mcap and rosbags are missing: ./dev readers";
  const test::Folder folder;
  write_bodies(*ros::make_bag_folder(folder / "run"));
  const json bag = read(folder, folder / "run");
  expect_bodies(bag);
  EXPECT_EQ(bag.at("statistics")[0], 10);
}

/// Two samples of a float array of a sensor, and one of labels in W.
void write_some_arrays(ros::Bag& bag) {
  const std::vector<float> scan = {0.5f, 1, -2, 3, 4, 5.25f};
  ros::ArrayMessage array{"ew/lidar front/scan",
                          "m",
                          "ranges",
                          "ew/lidar",
                          ros::ArrayElement::kFloat32,
                          {2, 3},
                          1.5,
                          {},
                          {}};
  array.data = std::as_bytes(std::span(scan));
  array.X_WF = body().X_PB;
  ros::write_array(bag, array);
  array.time = 1.75;
  ros::write_array(bag, array);
  const std::vector<std::uint16_t> labels = {7, 65535};
  bag.write("/clock", ros::MessageKind::kClock, 1'750'000'000LL, ros::clock(1'750'000'000LL));
  ros::write_array(bag, {"labels",
                         "1",
                         "kinds",
                         "world",
                         ros::ArrayElement::kUint16,
                         {2},
                         1.75,
                         {},
                         std::as_bytes(std::span(labels))});
  array.name = "ew/boom/scan";
  array.frame = "ew/boom";
  array.frame_is_known = true;
  ros::write_array(bag, array);
  array.shape = {7};
  EXPECT_THROW(ros::write_array(bag, array), Error);
  bag.close();
}

void expect_arrays(const json& bag) {
  ASSERT_FALSE(bag.is_discarded()) << "the reader failed";
  const json& scan = bag.at("/ew/lidar_front/scan");
  EXPECT_EQ(scan.at("type"), "std_msgs/msg/Float32MultiArray");
  EXPECT_EQ(scan.at("times"), json({1500000000, 1750000000}));
  EXPECT_EQ(scan.at("layout"), json({{"dim0", 2, 6}, {"dim1", 3, 3}, 0}));
  EXPECT_EQ(scan.at("data"), json({0.5, 1.0, -2.0, 3.0, 4.0, 5.25}));
  const json& about = bag.at("/ew/lidar_front/scan/description");
  EXPECT_EQ(about.at("times"), json({1500000000})) << "once, before the first sample";
  EXPECT_EQ(about.at("text"), json({{"name", "ew/lidar front/scan"},
                                    {"unit", "m"},
                                    {"meaning", "ranges"},
                                    {"frame", "ew/lidar"},
                                    {"type", "float32"},
                                    {"shape", {2, 3}}}));
  // An initializer list with one pair of texts would become an object.
  EXPECT_EQ(bag.at("/tf").at("frames"), json::array({json::array({"map", "ew/lidar"})}));
  EXPECT_EQ(bag.at("/tf").at("times").size(), 2u)
      << "an array in W has no separate frame, nor has one whose frame is known";
  EXPECT_EQ(about.at("durability"), "TRANSIENT_LOCAL");
  EXPECT_EQ(bag.at("/labels").at("type"), "std_msgs/msg/UInt16MultiArray");
  EXPECT_EQ(bag.at("/labels").at("data"), json({7.0, 65535.0}));
}

TEST(Mcap, ArraysAreReadByOthers) {
  if (readers().empty()) GTEST_SKIP() << "the readers mcap and rosbags are missing: ./dev readers";
  const test::Folder folder;
  write_some_arrays(*ros::make_mcap(folder / "run.mcap"));
  expect_arrays(read(folder, folder / "run.mcap"));
}

TEST(RosBag, ArraysAreReadByOthers) {
  if (readers().empty()) GTEST_SKIP() << "the readers mcap and rosbags are missing: ./dev readers";
  const test::Folder folder;
  write_some_arrays(*ros::make_bag_folder(folder / "run"));
  expect_arrays(read(folder, folder / "run"));
}

TEST(Bags, AreReproducibleByteForByte) {
  const test::Folder folder;
  write_map("mcap", example(), kTwo, folder / "a.mcap");
  write_map("mcap", example(), kTwo, folder / "b.mcap");
  EXPECT_EQ(read_file(folder / "a.mcap"), read_file(folder / "b.mcap"));
}

TEST(Bags, HoldTheBytesOfAnArray) {
  // Checked without readers: encapsulation, dimensions, length and text of the label, size, stride,
  // offset, count, numbers.
  const std::vector<double> numbers = {1.5, -2};
  const ros::Bytes bytes = ros::multi_array({2}, 8, std::as_bytes(std::span(numbers)));
  ASSERT_EQ(bytes.size(), 4u + 4 + 4 + 8 + 4 + 4 + 4 + 4 + 16);
  std::vector<double> read(2);
  std::memcpy(read.data(), bytes.data() + bytes.size() - 16, 16);
  EXPECT_EQ(read, numbers);
}

// Counts complete messages: in SQLite by rows, in MCAP by following its records up to a truncated
// one.
const char* const kCount = R"(
import sqlite3, struct, sys
if sys.argv[1].endswith('.db3'):
    print(sqlite3.connect(sys.argv[1]).execute('SELECT count(*) FROM messages').fetchone()[0])
else:
    data, at, count = open(sys.argv[1], 'rb').read(), 8, 0
    while at + 9 <= len(data):
        size = struct.unpack_from('<Q', data, at + 1)[0]
        if at + 9 + size > len(data): break
        count += data[at] == 5
        at += 9 + size
    print(count)
)";

TEST(Bags, KeepWrittenMessagesWhenTheDiskFillsUp) {
  if (std::system("/usr/bin/python3 -c 'import sqlite3' >/dev/null 2>&1") != 0)
    GTEST_SKIP() << "python3 is missing";
  const test::Folder folder;
  heightfield::testing::write_text(folder / "count.py", kCount);
  const ros::Bytes points = ros::point_cloud(example(), kTwo, 0);
  for (const bool mcap : {true, false}) {
    const std::string file = mcap ? folder / "run.mcap" : folder / "run/run_0.db3";
    const std::unique_ptr<ros::Bag> bag =
        mcap ? ros::make_mcap(file) : ros::make_bag_folder(folder / "run");
    rlimit before;
    ::getrlimit(RLIMIT_FSIZE, &before);
    const rlimit little{200000, before.rlim_max};
    const auto handler = ::signal(SIGXFSZ, SIG_IGN);
    ::setrlimit(RLIMIT_FSIZE, &little);
    std::string message;
    int written = 0;
    try {
      for (; written < 1000; ++written)
        bag->write("/terrain/points", ros::MessageKind::kPointCloud, written, points);
    } catch (const FileError& error) {
      message = error.what();
    }
    ::setrlimit(RLIMIT_FSIZE, &before);
    ::signal(SIGXFSZ, handler);
    EXPECT_NE(message.find("cannot write '" + file + "': "), std::string::npos) << message;
    EXPECT_GT(written, 10);
    const std::string counted = heightfield::testing::output_of(
        "/usr/bin/python3 '" + folder / "count.py" + "' '" + file + "'");
    // SQLite commits the transaction of one time when the next time comes.
    EXPECT_EQ(counted, std::to_string(mcap ? written : written - 1) + "\n") << file;
  }
}

/// Returns the number in bytes 0 to 7 from `at` on, least significant first.
std::uint64_t number_at(const std::vector<char>& bytes, std::size_t at) {
  std::uint64_t out = 0;
  for (std::size_t i = 0; i < 8; ++i)
    out |= static_cast<std::uint64_t>(static_cast<unsigned char>(bytes[at + i])) << 8 * i;
  return out;
}

TEST(Bags, ReportTheLeastAndTheGreatestTimeInAnyOrder) {
  const test::Folder folder;
  for (const bool mcap : {true, false}) {
    const std::unique_ptr<ros::Bag> bag =
        mcap ? ros::make_mcap(folder / "run.mcap") : ros::make_bag_folder(folder / "run");
    for (const std::int64_t ns : {300, 800, 100, 400})
      bag->write("/clock", ros::MessageKind::kClock, ns, ros::clock(ns));
    bag->close();
  }
  const std::vector<char> yaml = read_file(folder / "run/metadata.yaml");
  const std::string metadata(yaml.begin(), yaml.end());
  for (const char* part :
       {"nanoseconds: 700\n", "nanoseconds_since_epoch: 100\n", "message_count: 4\n"})
    EXPECT_NE(metadata.find(part), std::string::npos) << part << " in: " << metadata;
  // The statistics precede the last 8 + 29 bytes (magic, footer): for one topic they end with its
  // id, the count of its messages and, before the length of that map, both times.
  const std::vector<char> file = read_file(folder / "run.mcap");
  const std::size_t end = file.size() - 8 - 29;
  EXPECT_EQ(number_at(file, end - 8), 4u);
  EXPECT_EQ(number_at(file, end - 22), 800u);
  EXPECT_EQ(number_at(file, end - 30), 100u);
}

TEST(Bags, ReportUnwritablePathsAsFileErrors) {
  EXPECT_THROW(ros::make_mcap("/proc/no/such.mcap"), FileError);
  EXPECT_THROW(ros::make_bag_folder("/proc/no/such"), FileError);
}

}  // namespace
}  // namespace navvy::formats
