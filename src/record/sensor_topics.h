// SPDX-License-Identifier: Apache-2.0
// Readings of sensors as messages of sensor_msgs in a ROS bag, made from the arrays of a world.
#pragma once

#include <cstdint>
#include <set>
#include <string>
#include <variant>
#include <vector>

#include "formats/ros/bag.h"
#include "formats/ros/machine_frames.h"
#include "formats/ros/sensor_messages.h"
#include "sim/array_outputs.h"

namespace navvy::record {

/// A sensor of a machine, with the arrays in which its readings arrive. S is the sensor's frame: x
/// forward, y left, z up. Arrays are given by their indices in sim::World::arrays.
struct SensorStream {
  /// Ranges of beams in the x-y plane of S, by increasing angle, as REP 117 has them.
  struct Scan {
    int ranges = -1;                      ///< array [beams] of float32 [m]
    double angle_min = 0;                 ///< angle of the first beam about z from x [rad]
    double angle_increment = 0;           ///< angle between two beams [rad]
    double time_increment = 0;            ///< time between two beams [s]
    double period = 0;                    ///< time between two scans [s]
    double range_min = 0, range_max = 0;  ///< smallest and greatest valid range [m]
  };
  /// Distances along any directions, as of a scanner with several rings or a time-of-flight camera.
  struct Cloud {
    int distances = -1;            ///< array [rows, columns] of float32 [m]
    int intensities = -1;          ///< array of the same shape, float32; -1: none
    std::uint32_t rows = 1;        ///< number of rows
    std::vector<Vec3> directions;  ///< unit vector in S of each element
    std::vector<float> times;      ///< time of each element after the stamp [s]; empty: none
  };
  /// One distance along x of S.
  struct Distance {
    int range = -1;  ///< array [1] of float32 [m]
    formats::ros::RangeMessage::Radiation radiation =
        formats::ros::RangeMessage::Radiation::kUltrasound;  ///< physical principle
    double field_of_view = 0;                                ///< full angle of the cone [rad]
    double range_min = 0, range_max = 0;  ///< smallest and greatest valid distance [m]
  };
  /// Angular velocity, specific force and orientation.
  struct Inertial {
    /// Arrays [3] of float64 in S [rad/s], [m/s2], and [4] of float64, w x y z of the rotation from
    /// S to W; -1: no orientation.
    int angular_velocity = -1, linear_acceleration = -1, orientation = -1;
    /// Variances of the components [rad2/s2] and [m2/s4].
    Vec3 velocity_variance = Vec3::Zero(), acceleration_variance = Vec3::Zero();
  };
  /// Position of a satellite receiver.
  struct Fix {
    int position = -1;             ///< array [3] of float64 in W [m]; NaN: no fix
    Vec3 variance = Vec3::Zero();  ///< variances along x, y and z of W [m2]
  };
  /// Picture of a pinhole camera that looks along x of S.
  struct Picture {
    int pixels = -1;       ///< array [rows, columns] or [rows, columns, channels]
    std::string encoding;  ///< type of a pixel as in formats::ros::ImageMessage
    double fov = 1;        ///< horizontal field of view [rad]
    double baseline = 0;   ///< distance to the left camera of a pair [m]; 0: none
  };
  /// Position, velocity and effort of one joint.
  struct Joint {
    int state = -1;     ///< array [3] of float64
    std::string joint;  ///< name of the joint
  };

  int machine = -1;          ///< index of the machine in the scene
  int link = -1;             ///< index of the link that carries the sensor in its machine
  std::string machine_name;  ///< name of the machine
  std::string name;          ///< name of the sensor, unique within its machine
  /// Name of the frame S within the machine: that of the sensor, unless a link has it
  /// (formats::ros::name_beside_links).
  std::string frame;
  Pose X_LS = Pose::Identity();  ///< pose of the sensor in the frame of the link
  /// Quantity that the sensor measures. Without a value it has a frame alone, and its arrays are
  /// written by themselves.
  std::variant<std::monostate, Scan, Cloud, Distance, Inertial, Fix, Picture, Joint> kind;

  /// Returns the names of the frames of the sensor in those of its machine and their poses in the
  /// frame of the link: S, and for cameras the optical frame (z forward, x right, y down) under
  /// "<frame>_optical".
  std::vector<formats::ros::MachineFrame> frames() const;
};

/// Writes the readings of sensors into a ROS bag.
///
/// Each sensor has topics below /<machine>/<sensor>: `scan` (LaserScan), `points` (PointCloud2),
/// `range` (Range), `imu` (Imu), `fix` (NavSatFix), `image` and `camera_info` (Image, CameraInfo)
/// or `joint_states` (JointState). Stamps are times of measurement, and the times of the bag those
/// of delivery. Latitude and longitude are those of a plane that touches the WGS 84 ellipsoid at
/// W's origin, at 0 degrees north and east, with x east and y north.
class SensorTopics {
 public:
  /// Prepares topics for `sensors`. `arrays` must outlive this object.
  SensorTopics(const std::vector<SensorStream>& sensors, const sim::ArrayOutputs& arrays);

  /// Forgets which readings were written. Must be called before the first message to a new bag.
  void restart();
  /// Appends all new readings. `time_ns` is the simulated time [ns].
  /// @throws FileError if the bag cannot be written.
  void write(formats::ros::Bag& bag, std::int64_t time_ns);
  /// Returns true if the array is in the messages of a sensor without loss, so that it need not be
  /// written by itself.
  bool has_array(int array) const { return arrays_written_.count(array) > 0; }

 private:
  std::vector<SensorStream> sensors_;
  const sim::ArrayOutputs& arrays_;
  /// Sequence number of the last reading of each sensor.
  std::vector<std::uint64_t> sequences_;
  std::set<int> arrays_written_;
};

}  // namespace navvy::record
