// SPDX-License-Identifier: Apache-2.0
#include "record/sensor_topics.h"

#include <cmath>
#include <limits>

#include "core/error.h"
#include "formats/ros/streams.h"

namespace navvy::record {
namespace {

namespace ros = formats::ros;

// WGS 84: semi-major axis [m] and square of the eccentricity of the ellipsoid.
constexpr double kMajorAxis = 6378137;
constexpr double kEccentricity2 = 6.69437999014e-3;

/// Rotation from the optical frame (z forward, x right, y down) to S.
Mat3 optical_axes() {
  Mat3 R;
  R << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  return R;
}

/// Writes one reading; there is one function per kind of sensor.
struct Writing {
  const SensorStream& sensor;
  const sim::ArrayOutputs& arrays;
  ros::Bag& bag;
  std::int64_t now;

  std::string topic(const char* name) const {
    return "/" + ros::topic_part(sensor.machine_name) + "/" + ros::topic_part(sensor.name) + "/" +
           name;
  }
  ros::MessageHeader header(const sim::ArrayView& view, const std::string& suffix = "") const {
    return {ros::stamp(view.time()), sensor.machine_name + "/" + sensor.frame + suffix};
  }
  template <class T>
  std::vector<T> values(int array) const {
    const auto all = arrays.view(array).values<T>();
    return {all.begin(), all.end()};
  }
  Vec3 vector(int array) const {
    const auto v = arrays.view(array).values<double>();
    return {v[0], v[1], v[2]};
  }

  void operator()(std::monostate) const {}
  void operator()(const SensorStream::Scan& scan) const {
    bag.write(topic("scan"), ros::MessageKind::kLaserScan, now,
              ros::laser_scan({header(arrays.view(scan.ranges)),
                               scan.angle_min,
                               scan.angle_increment,
                               scan.time_increment,
                               scan.period,
                               scan.range_min,
                               scan.range_max,
                               values<float>(scan.ranges),
                               {}}));
  }
  void operator()(const SensorStream::Cloud& cloud) const;
  void operator()(const SensorStream::Distance& distance) const {
    const sim::ArrayView view = arrays.view(distance.range);
    bag.write(topic("range"), ros::MessageKind::kRange, now,
              ros::range({header(view), distance.radiation, distance.field_of_view,
                          distance.range_min, distance.range_max, view.values<float>()[0]}));
  }
  void operator()(const SensorStream::Inertial& inertial) const;
  void operator()(const SensorStream::Fix& fix) const;
  void operator()(const SensorStream::Picture& picture) const;
  void operator()(const SensorStream::Joint& joint) const {
    const Vec3 state = vector(joint.state);
    bag.write(topic("joint_states"), ros::MessageKind::kJointState, now,
              ros::joint_state({{joint.joint}, {state.x()}, {state.y()}, {state.z()}},
                               ros::stamp(arrays.view(joint.state).time())));
  }
};

// Points without a return are kept, so that an ordered cloud stays ordered.
void Writing::operator()(const SensorStream::Cloud& cloud) const {
  const sim::ArrayView view = arrays.view(cloud.distances);
  const auto distances = view.values<float>();
  const bool intensity = cloud.intensities >= 0, times = !cloud.times.empty();
  ros::PointCloudMessage out{header(view), {"x", "y", "z"}, cloud.rows, {}, true};
  if (intensity) out.fields.emplace_back("intensity");
  if (times) out.fields.emplace_back("time");
  for (std::size_t i = 0; i < distances.size(); ++i) {
    const bool hit = std::isfinite(distances[i]);
    const float nan = std::numeric_limits<float>::quiet_NaN();
    for (int axis = 0; axis < 3; ++axis)
      out.values.push_back(hit ? static_cast<float>(distances[i] * cloud.directions.at(i)[axis])
                               : nan);
    if (intensity) out.values.push_back(arrays.view(cloud.intensities).values<float>()[i]);
    if (times) out.values.push_back(cloud.times.at(i));
    out.dense = out.dense && hit;
  }
  bag.write(topic("points"), ros::MessageKind::kPointCloud, now, ros::point_cloud(out));
}

void Writing::operator()(const SensorStream::Inertial& inertial) const {
  ros::ImuMessage out;
  out.header = header(arrays.view(inertial.angular_velocity));
  out.angular_velocity = vector(inertial.angular_velocity);
  out.linear_acceleration = vector(inertial.linear_acceleration);
  out.angular_velocity_covariance = inertial.velocity_variance.asDiagonal();
  out.linear_acceleration_covariance = inertial.acceleration_variance.asDiagonal();
  if (inertial.orientation >= 0) {
    const auto q = arrays.view(inertial.orientation).values<double>();
    out.orientation = Eigen::Quaterniond(q[0], q[1], q[2], q[3]).toRotationMatrix();
  }
  bag.write(topic("imu"), ros::MessageKind::kImu, now, ros::imu(out));
}

// At the equator the ellipsoid has its radii a (1 - e2) along the meridian and a across it.
void Writing::operator()(const SensorStream::Fix& fix) const {
  const Vec3 p_W = vector(fix.position);
  ros::NavSatMessage out;
  out.header = header(arrays.view(fix.position));
  out.fix = p_W.allFinite();
  out.latitude = degrees(p_W.y() / (kMajorAxis * (1 - kEccentricity2)));
  out.longitude = degrees(p_W.x() / kMajorAxis);
  out.altitude = p_W.z();
  out.covariance = fix.variance.asDiagonal();
  bag.write(topic("fix"), ros::MessageKind::kNavSatFix, now, ros::nav_sat_fix(out));
}

void Writing::operator()(const SensorStream::Picture& picture) const {
  const sim::ArrayView view = arrays.view(picture.pixels);
  const std::vector<int>& shape = view.channel().shape;
  const auto height = static_cast<std::uint32_t>(shape.at(0));
  const auto width = static_cast<std::uint32_t>(shape.at(1));
  const ros::MessageHeader at = header(view, "_optical");
  bag.write(topic("image"), ros::MessageKind::kImage, now,
            ros::image({at, width, height, picture.encoding, view.bytes()}));
  // Square pixels; the optical axis passes between the middle pixels of an even number.
  const double focal = 0.5 * width / std::tan(0.5 * picture.fov);
  bag.write(topic("camera_info"), ros::MessageKind::kCameraInfo, now,
            ros::camera_info({at, width, height, focal, focal, 0.5 * (width - 1.0),
                              0.5 * (height - 1.0), picture.baseline}));
}

/// Returns the arrays of a sensor. The first one says when there is a new reading.
std::vector<int> arrays_of(const SensorStream& sensor) {
  struct List {
    std::vector<int> operator()(std::monostate) const { return {}; }
    std::vector<int> operator()(const SensorStream::Scan& s) const { return {s.ranges}; }
    std::vector<int> operator()(const SensorStream::Cloud& s) const {
      return {s.distances, s.intensities};
    }
    std::vector<int> operator()(const SensorStream::Distance& s) const { return {s.range}; }
    std::vector<int> operator()(const SensorStream::Inertial& s) const {
      return {s.angular_velocity, s.linear_acceleration, s.orientation};
    }
    std::vector<int> operator()(const SensorStream::Fix& s) const { return {s.position}; }
    std::vector<int> operator()(const SensorStream::Picture& s) const { return {s.pixels}; }
    std::vector<int> operator()(const SensorStream::Joint& s) const { return {s.state}; }
  };
  return std::visit(List(), sensor.kind);
}

}  // namespace

std::vector<formats::ros::MachineFrame> SensorStream::frames() const {
  std::vector<ros::MachineFrame> out = {{frame, -1, link, X_LS, -1}};
  if (!std::holds_alternative<Picture>(kind)) return out;
  Pose X_LO = X_LS;
  X_LO.linear() = X_LS.linear() * optical_axes();
  out.push_back({frame + "_optical", -1, link, X_LO, -1});
  return out;
}

SensorTopics::SensorTopics(const std::vector<SensorStream>& sensors,
                           const sim::ArrayOutputs& arrays)
    : sensors_(sensors), arrays_(arrays), sequences_(sensors.size()) {
  for (const SensorStream& sensor : sensors_)
    // A position in W says more than its latitude.
    if (!std::holds_alternative<SensorStream::Fix>(sensor.kind))
      for (const int array : arrays_of(sensor)) arrays_written_.insert(array);
}

void SensorTopics::restart() { sequences_.assign(sensors_.size(), 0); }

void SensorTopics::write(formats::ros::Bag& bag, std::int64_t time_ns) {
  for (std::size_t i = 0; i < sensors_.size(); ++i) {
    const std::vector<int> arrays = arrays_of(sensors_[i]);
    if (arrays.empty()) continue;
    // Number 0 is an array without a sample.
    const std::uint64_t sequence = arrays_.view(arrays.front()).sequence();
    if (sequence == sequences_[i]) continue;
    sequences_[i] = sequence;
    std::visit(Writing{sensors_[i], arrays_, bag, time_ns}, sensors_[i].kind);
  }
}

}  // namespace navvy::record
