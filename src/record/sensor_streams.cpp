// SPDX-License-Identifier: Apache-2.0
#include "record/sensor_streams.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "sensor/pixels.h"
#include "sensor/sensor_output.h"

namespace navvy::record {
namespace {

double square(double x) { return x * x; }

/// Makes the part of a stream that depends on the kind of the sensor; one function per kind.
struct StreamOf {
  const sensor::SensorOutput& output;

  int array(const std::string& quantity) const {
    for (const sensor::SensorArray& one : output.arrays)
      if (one.quantity == quantity) return one.index;
    return -1;
  }
  static Vec3 variances(const scene::NoiseOfVector& noise) {
    return {square(noise.x.noise.stddev), square(noise.y.noise.stddev),
            square(noise.z.noise.stddev)};
  }

  using Kind = decltype(SensorStream::kind);
  // Kinds without a message of their own.
  template <class Other>
  Kind operator()(const Other&) const {
    return {};
  }
  Kind operator()(const scene::Lidar& lidar) const {
    const int beams = lidar.horizontal.samples, rings = lidar.vertical.samples;
    const double gaps = std::max(1, beams - 1);
    if (rings == 1 && lidar.vertical.angle(0) == 0)
      return SensorStream::Scan{
          array("ranges"),
          lidar.horizontal.angle(0),
          beams < 2 ? 0 : lidar.horizontal.angle(1) - lidar.horizontal.angle(0),
          lidar.sweep / gaps,
          1 / output.description->rate,
          lidar.range.min,
          lidar.range.max};
    SensorStream::Cloud out{array("ranges"), -1, static_cast<std::uint32_t>(rings), {}, {}};
    for (int ring = 0; ring < rings; ++ring)
      for (int beam = 0; beam < beams; ++beam) {
        const double up = lidar.vertical.angle(ring), left = lidar.horizontal.angle(beam);
        out.directions.emplace_back(std::cos(up) * std::cos(left), std::cos(up) * std::sin(left),
                                    std::sin(up));
        out.times.push_back(static_cast<float>(lidar.sweep * beam / gaps));
      }
    return out;
  }
  Kind operator()(const scene::Sonar& sonar) const {
    return SensorStream::Distance{array("range"),
                                  formats::ros::RangeMessage::Radiation::kUltrasound,
                                  2 * std::atan(sonar.radius / sonar.max), sonar.min, sonar.max};
  }
  Kind operator()(const scene::Infrared& infrared) const {
    return SensorStream::Distance{array("range"), formats::ros::RangeMessage::Radiation::kInfrared,
                                  infrared.spot, infrared.range.min, infrared.range.max};
  }
  Kind operator()(const scene::TimeOfFlight& camera) const {
    SensorStream::Cloud out{
        array("distances"), array("amplitudes"), static_cast<std::uint32_t>(camera.height), {}, {}};
    const sensor::Pixels pixels(camera.width, camera.height, camera.fov);
    for (int row = 0; row < camera.height; ++row)
      for (int column = 0; column < camera.width; ++column)
        out.directions.push_back(pixels.ray(column + 0.5, row + 0.5).normalized());
    return out;
  }
  Kind operator()(const scene::Imu& imu) const {
    return SensorStream::Inertial{array("angular_velocity"), array("linear_acceleration"),
                                  array("orientation"), variances(imu.angular_velocity),
                                  variances(imu.linear_acceleration)};
  }
  Kind operator()(const scene::Gnss& gnss) const {
    const double level = square(gnss.position.horizontal.noise.stddev);
    return SensorStream::Fix{array("position"),
                             {level, level, square(gnss.position.vertical.noise.stddev)}};
  }
  Kind operator()(const scene::JointGauge& gauge) const {
    return SensorStream::Joint{array("state"), gauge.joint};
  }
  Kind operator()(const scene::DepthCamera& camera) const {
    return SensorStream::Picture{array("depth"), "32FC1", camera.fov, 0};
  }
  Kind operator()(const scene::LabelCamera& camera) const {
    return SensorStream::Picture{array("labels"), "16UC1", camera.fov, 0};
  }
  Kind operator()(const scene::ColourCamera& camera) const {
    return SensorStream::Picture{array("image"), "rgb8", camera.fov, 0};
  }
};

/// Appends the two cameras of a pair, with frames of their own below that of the pair.
void add_pair(const StreamOf& of, const scene::StereoCamera& camera, const SensorStream& pair,
              std::vector<SensorStream>& out) {
  for (const bool right : {false, true}) {
    const std::string side = right ? "right" : "left";
    const double baseline = right ? camera.baseline : 0;
    SensorStream one = pair;
    one.name += "_" + side;
    one.frame += "_" + side;
    one.X_LS = pair.X_LS * make_pose(0, -baseline, 0, 0, 0, 0);
    one.kind = SensorStream::Picture{of.array(side), "rgb8", camera.fov, baseline};
    out.push_back(std::move(one));
  }
}

}  // namespace

std::vector<SensorStream> sensor_streams(const sim::World& world) {
  std::vector<SensorStream> out;
  for (const sensor::SensorOutput& output : sensor::sensor_outputs(world)) {
    const scene::Sensor& about = *output.description;
    const sim::MachineHandle machine = world.machines().at(output.machine);
    out.push_back({output.machine, output.link, machine.name(), about.name,
                   formats::ros::name_beside_links(machine.description(), about.name), about.X_LS,
                   std::visit(StreamOf{output}, about.kind)});
    if (const auto* pair = std::get_if<scene::StereoCamera>(&about.kind)) {
      const SensorStream whole = out.back();
      add_pair(StreamOf{output}, *pair, whole, out);
    }
  }
  return out;
}

}  // namespace navvy::record
