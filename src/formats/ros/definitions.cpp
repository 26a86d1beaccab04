// SPDX-License-Identifier: Apache-2.0
// Definitions of the messages, field by field: readers of an MCAP file know no type beyond its
// schemas.
#include <map>

#include "formats/ros/messages.h"

namespace navvy::formats::ros {
namespace {

struct Row {
  const char* name;
  const char* fields;
};

const Row kTypes[] = {
    {"builtin_interfaces/Time", "int32 sec\nuint32 nanosec\n"},
    {"std_msgs/Header", "builtin_interfaces/Time stamp\nstring frame_id\n"},
    {"std_msgs/MultiArrayDimension", "string label\nuint32 size\nuint32 stride\n"},
    {"std_msgs/MultiArrayLayout", "std_msgs/MultiArrayDimension[] dim\nuint32 data_offset\n"},
    {"std_msgs/String", "string data\n"},
    {"std_msgs/UInt8MultiArray", "std_msgs/MultiArrayLayout layout\nuint8[] data\n"},
    {"std_msgs/UInt16MultiArray", "std_msgs/MultiArrayLayout layout\nuint16[] data\n"},
    {"std_msgs/Int32MultiArray", "std_msgs/MultiArrayLayout layout\nint32[] data\n"},
    {"std_msgs/Float64MultiArray", "std_msgs/MultiArrayLayout layout\nfloat64[] data\n"},
    {"std_msgs/Float32MultiArray", "std_msgs/MultiArrayLayout layout\nfloat32[] data\n"},
    {"geometry_msgs/Point", "float64 x\nfloat64 y\nfloat64 z\n"},
    {"geometry_msgs/Vector3", "float64 x\nfloat64 y\nfloat64 z\n"},
    // Numbers behind the names are the defaults of ROS's definition.
    {"geometry_msgs/Quaternion", "float64 x 0\nfloat64 y 0\nfloat64 z 0\nfloat64 w 1\n"},
    {"geometry_msgs/Pose", "geometry_msgs/Point position\ngeometry_msgs/Quaternion orientation\n"},
    {"geometry_msgs/PoseWithCovariance", "geometry_msgs/Pose pose\nfloat64[36] covariance\n"},
    {"geometry_msgs/Twist", "geometry_msgs/Vector3 linear\ngeometry_msgs/Vector3 angular\n"},
    {"geometry_msgs/TwistWithCovariance", "geometry_msgs/Twist twist\nfloat64[36] covariance\n"},
    {"geometry_msgs/Transform",
     "geometry_msgs/Vector3 translation\ngeometry_msgs/Quaternion rotation\n"},
    {"geometry_msgs/TransformStamped",
     "std_msgs/Header header\nstring child_frame_id\ngeometry_msgs/Transform transform\n"},
    {"grid_map_msgs/GridMapInfo",
     "float64 resolution\nfloat64 length_x\nfloat64 length_y\ngeometry_msgs/Pose pose\n"},
    {"grid_map_msgs/GridMap",
     "std_msgs/Header header\ngrid_map_msgs/GridMapInfo info\nstring[] layers\nstring[] "
     "basic_layers\n"
     "std_msgs/Float32MultiArray[] data\nuint16 outer_start_index\nuint16 inner_start_index\n"},
    {"nav_msgs/MapMetaData",
     "builtin_interfaces/Time map_load_time\nfloat32 resolution\nuint32 width\nuint32 height\n"
     "geometry_msgs/Pose origin\n"},
    {"nav_msgs/OccupancyGrid", "std_msgs/Header header\nnav_msgs/MapMetaData info\nint8[] data\n"},
    {"nav_msgs/Odometry",
     "std_msgs/Header header\nstring child_frame_id\ngeometry_msgs/PoseWithCovariance pose\n"
     "geometry_msgs/TwistWithCovariance twist\n"},
    {"sensor_msgs/PointField", "string name\nuint32 offset\nuint8 datatype\nuint32 count\n"},
    {"sensor_msgs/PointCloud2",
     "std_msgs/Header header\nuint32 height\nuint32 width\nsensor_msgs/PointField[] fields\nbool "
     "is_bigendian\n"
     "uint32 point_step\nuint32 row_step\nuint8[] data\nbool is_dense\n"},
    {"sensor_msgs/JointState",
     "std_msgs/Header header\nstring[] name\nfloat64[] position\nfloat64[] velocity\nfloat64[] "
     "effort\n"},
    {"sensor_msgs/LaserScan",
     "std_msgs/Header header\nfloat32 angle_min\nfloat32 angle_max\nfloat32 angle_increment\n"
     "float32 time_increment\nfloat32 scan_time\nfloat32 range_min\nfloat32 range_max\n"
     "float32[] ranges\nfloat32[] intensities\n"},
    {"sensor_msgs/Range",
     "std_msgs/Header header\nuint8 radiation_type\nfloat32 field_of_view\nfloat32 min_range\n"
     "float32 max_range\nfloat32 range\n"},
    {"sensor_msgs/Imu",
     "std_msgs/Header header\ngeometry_msgs/Quaternion orientation\n"
     "float64[9] orientation_covariance\ngeometry_msgs/Vector3 angular_velocity\n"
     "float64[9] angular_velocity_covariance\ngeometry_msgs/Vector3 linear_acceleration\n"
     "float64[9] linear_acceleration_covariance\n"},
    {"sensor_msgs/NavSatStatus", "int8 status\nuint16 service\n"},
    {"sensor_msgs/NavSatFix",
     "std_msgs/Header header\nsensor_msgs/NavSatStatus status\nfloat64 latitude\n"
     "float64 longitude\nfloat64 altitude\nfloat64[9] position_covariance\n"
     "uint8 position_covariance_type\n"},
    {"sensor_msgs/Image",
     "std_msgs/Header header\nuint32 height\nuint32 width\nstring encoding\n"
     "uint8 is_bigendian\nuint32 step\nuint8[] data\n"},
    {"sensor_msgs/RegionOfInterest",
     "uint32 x_offset\nuint32 y_offset\nuint32 height\nuint32 width\nbool do_rectify\n"},
    {"sensor_msgs/CameraInfo",
     "std_msgs/Header header\nuint32 height\nuint32 width\nstring distortion_model\n"
     "float64[] d\nfloat64[9] k\nfloat64[9] r\nfloat64[12] p\nuint32 binning_x\n"
     "uint32 binning_y\nsensor_msgs/RegionOfInterest roi\n"},
    {"tf2_msgs/TFMessage", "geometry_msgs/TransformStamped[] transforms\n"},
    {"rosgraph_msgs/Clock", "builtin_interfaces/Time clock\n"},
};

const char* fields_of(const std::string& name) {
  for (const Row& row : kTypes)
    if (name == row.name) return row.fields;
  return nullptr;
}

/// Collects the types that a definition names, in the order of their appearance, each once over the
/// whole walk.
void parts_of(const std::string& fields, std::vector<std::string>& out) {
  for (std::size_t at = 0; at < fields.size(); at = fields.find('\n', at) + 1) {
    // A field is its type, with brackets for a sequence, a blank and its name.
    const std::string type = fields.substr(at, fields.find_first_of(" [", at) - at);
    const char* own = fields_of(type);
    bool seen = own == nullptr;
    for (const std::string& other : out) seen = seen || other == type;
    if (seen) continue;
    out.push_back(type);
    parts_of(own, out);
  }
}

/// In the order of the enumerators.
constexpr const char* kNames[kMessageKinds] = {
    "grid_map_msgs/GridMap",      "nav_msgs/OccupancyGrid",
    "sensor_msgs/PointCloud2",    "nav_msgs/Odometry",
    "sensor_msgs/JointState",     "tf2_msgs/TFMessage",
    "rosgraph_msgs/Clock",        "std_msgs/String",
    "std_msgs/UInt8MultiArray",   "std_msgs/UInt16MultiArray",
    "std_msgs/Int32MultiArray",   "std_msgs/Float32MultiArray",
    "std_msgs/Float64MultiArray", "sensor_msgs/LaserScan",
    "sensor_msgs/Range",          "sensor_msgs/Imu",
    "sensor_msgs/NavSatFix",      "sensor_msgs/Image",
    "sensor_msgs/CameraInfo"};

std::string short_name(MessageKind kind) { return kNames[static_cast<int>(kind)]; }

}  // namespace

const std::string& type_name(MessageKind kind) {
  static const std::map<MessageKind, std::string> names = [] {
    std::map<MessageKind, std::string> out;
    for (int i = 0; i < kMessageKinds; ++i) {
      std::string name = short_name(static_cast<MessageKind>(i));
      out[static_cast<MessageKind>(i)] = name.insert(name.find('/'), "/msg");
    }
    return out;
  }();
  return names.at(kind);
}

// Built once: bags ask for it per channel.
const std::string& definition(MessageKind kind) {
  // The definition has the fields of the message, then every type that they name, each after a line
  // of 80 equal signs and its name.
  static const std::map<MessageKind, std::string> texts = [] {
    std::map<MessageKind, std::string> out;
    for (int i = 0; i < kMessageKinds; ++i) {
      std::string text = fields_of(short_name(static_cast<MessageKind>(i)));
      std::vector<std::string> parts;
      parts_of(text, parts);
      for (const std::string& part : parts)
        text += std::string(80, '=') + "\nMSG: " + part + "\n" + fields_of(part);
      out[static_cast<MessageKind>(i)] = text;
    }
    return out;
  }();
  return texts.at(kind);
}

}  // namespace navvy::formats::ros
