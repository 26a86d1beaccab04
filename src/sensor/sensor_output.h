// SPDX-License-Identifier: Apache-2.0
// What the sensors of a world publish: names, kinds and frames of their arrays.
#pragma once

#include <string>
#include <vector>

#include "scene/sensor.h"
#include "sim/world.h"

namespace navvy::sensor {

/// One array that a sensor publishes. `sim::World::arrays().view(index)` returns its latest value
/// without a copy: element type, shape and unit, the number of readings so far
/// (`ArrayView::sequence`, a counter that grows with each new reading), the time of the measurement
/// (`time`) and of its delivery (`delivered`), and the pose of the sensor in W at the measurement
/// (`X_WF`).
struct SensorArray {
  std::string quantity;  ///< what is measured, such as "ranges"
  int index = -1;        ///< index in sim::World::arrays
};

/// A sensor of a running world and its arrays. The kinds publish (shape, element type, unit):
///
/// - lidar: ranges [rings, beams] or [beams] float32 m, as in REP 117: inf beyond the range, -inf
///   below it, NaN for a dropped beam;
/// - sonar, infrared: range [1] float32 m, as above;
/// - time of flight: distances and amplitudes [rows, columns] float32, m and 1;
/// - IMU: angular_velocity [3] float64 rad/s and linear_acceleration [3] float64 m/s2 in S,
///   orientation [4] float64 as w x y z of the rotation from S to W, without errors;
/// - GNSS: position [3] and velocity [3] float64 in W, NaN without a fix, and status [2] int32: 1
///   with a fix, and the number of visible satellites;
/// - joint: state [3] float64: position, velocity, effort;
/// - cylinder: pressure [2] float64 Pa of the head and the rod side, length [1] float64 m;
/// - contact: contact [2] float64: 1 if the switch was closed since the last reading, and the
///   largest normal force since then [N];
/// - tool force: wrench [6] float64: force [N] and moment about the origin of S [N m], in S;
/// - payload: mass [1] float64 kg;
/// - depth camera: depth [rows, columns] float32 m along x of S, inf and -inf as above;
/// - label camera: labels [rows, columns] uint16: 0 nothing, 1 ground, 2 loose soil in the air or
///   in a tool, 3 + i the machine with index i in the scene;
/// - camera: image [rows, columns, 3] uint8 sRGB; stereo: left and right, likewise;
/// - map: elevation and predicted [rows, columns] float32 m, NaN where nothing is known, from the
///   smallest y and x; score [4] float64: share of known cells, rms, mean and largest magnitude of
///   elevation - truth [m].
struct SensorOutput {
  int machine = -1;                            ///< index in scene::Scene::machines
  int link = -1;                               ///< index of the carrying link in its machine
  const scene::Sensor* description = nullptr;  ///< the sensor in the scene, valid as long as it
  std::string name;                            ///< "machine/sensor", also the name of its frame S
  std::string link_name;                       ///< "machine/link", the parent of S
  std::vector<SensorArray> arrays;             ///< arrays in the order of their publication
};

/// Returns the sensors of a world that have been added to it (make_sensors), in the order of the
/// scene.
std::vector<SensorOutput> sensor_outputs(const sim::World& world);

}  // namespace navvy::sensor
