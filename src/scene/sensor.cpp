// SPDX-License-Identifier: Apache-2.0
#include "scene/sensor.h"

#include <type_traits>

namespace navvy::scene {
namespace {

template <class T, std::size_t I = 0>
constexpr std::size_t index_of_kind() {
  if constexpr (std::is_same_v<std::variant_alternative_t<I, SensorKind>, T>)
    return I;
  else
    return index_of_kind<T, I + 1>();
}

/// Returns a sensor kind of each alternative, in the order of the variant.
template <std::size_t... I>
std::vector<SensorKind> fresh_kinds(std::index_sequence<I...>) {
  return {SensorKind(std::in_place_index<I>)...};
}

const SensorKind& fresh_kind(std::size_t kind) {
  static const std::vector<SensorKind> kinds =
      fresh_kinds(std::make_index_sequence<std::variant_size_v<SensorKind>>());
  return kinds.at(kind);
}

}  // namespace

const std::vector<SensorType>& sensor_types() {
  static const std::vector<SensorType> types = {
      {"lidar", index_of_kind<Lidar>()},
      {"gpu_lidar", index_of_kind<Lidar>()},
      {"ray", index_of_kind<Lidar>()},
      {"gpu_ray", index_of_kind<Lidar>()},
      {"sonar", index_of_kind<Sonar>()},
      {"navvy:infrared", index_of_kind<Infrared>()},
      {"navvy:time_of_flight", index_of_kind<TimeOfFlight>()},
      {"imu", index_of_kind<Imu>()},
      {"navsat", index_of_kind<Gnss>()},
      {"gps", index_of_kind<Gnss>()},
      {"navvy:joint", index_of_kind<JointGauge>()},
      {"navvy:cylinder", index_of_kind<CylinderPressure>()},
      {"contact", index_of_kind<ContactSwitch>()},
      {"navvy:tool_force", index_of_kind<ToolForce>()},
      {"navvy:payload", index_of_kind<PayloadScale>()},
      {"depth_camera", index_of_kind<DepthCamera>()},
      {"depth", index_of_kind<DepthCamera>()},
      {"segmentation", index_of_kind<LabelCamera>()},
      {"camera", index_of_kind<ColourCamera>()},
      {"navvy:stereo", index_of_kind<StereoCamera>()},
      {"navvy:map", index_of_kind<OwnMap>()},
  };
  return types;
}

void Sensor::describe(Fields& f) {
  f.attribute("name", name, "Name of the sensor, unique within the machine.", kNeeded);
  f.attribute("link", link, "Link that carries the sensor; only of <navvy:sensor>.");
  f("navvy:preset", preset, "Preset whose elements fill in those that are missing here.");
  f("pose", X_LS, "Place x y z [m] and turn roll pitch yaw [rad] in the link.", kSdf);
  f("update_rate", rate, {1e-3, 1e5}, "Readings per second.", kSdf | kNeeded);
  f("navvy:latency_s", latency, {0, 60}, "Time from the measurement to its delivery.");
  ignored.describe(f);
  const std::vector<SensorType>& all = sensor_types();
  Types types{"type", "Kind of the sensor.", {}, 0, {}, {}};
  for (std::size_t i = 0; i < all.size(); ++i) {
    types.names.push_back(all[i].name);
    if (type == all[i].name) types.index = i;
  }
  types.choose = [this, &all](std::size_t i) {
    type = all[i].name;
    kind = fresh_kind(all[i].kind);
  };
  types.describe = [this, &all](std::size_t i, Fields& inner) {
    SensorKind other = fresh_kind(all[i].kind);
    SensorKind& described = all[i].kind == kind.index() ? kind : other;
    std::visit([&inner](auto& one) { one.describe(inner); }, described);
  };
  f.types(types);
}

}  // namespace navvy::scene
