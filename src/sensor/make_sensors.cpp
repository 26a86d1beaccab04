// SPDX-License-Identifier: Apache-2.0
#include "sensor/make_sensors.h"

#include <algorithm>
#include <functional>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <variant>

#include "core/error.h"
#include "core/log.h"
#include "heightfield/make_ground.h"
#include "scene/forward_kinematics.h"
#include "sensor/camera/picture_scene.h"
#include "sensor/ray_scene.h"
#include "sensor/sensor_output.h"
#include "sensor/sensor_sampler.h"
#include "sensor/shape_mesh.h"
#include "sim/start_placing.h"
#include "sim/step_length.h"

namespace navvy::sensor {
namespace {

/// What a check of sensors must know of a world, which need not exist yet.
struct Surroundings {
  double dt;  ///< base step [s]
  /// Returns the pose in W of a link, given by the indices of machine and link.
  std::function<Pose(std::size_t, std::size_t)> X_WL;
  /// Returns what a point in W is inside of.
  std::function<Enclosure(const Vec3&)> around;
};

/// Returns true for a sensor that must not be inside a body or below the ground.
bool needs_view(const scene::Sensor& sensor) {
  return std::visit(
      []<class Kind>(const Kind&) {
        return !std::is_same_v<Kind, scene::Imu> && !std::is_same_v<Kind, scene::JointGauge> &&
               !std::is_same_v<Kind, scene::CylinderPressure> &&
               !std::is_same_v<Kind, scene::ContactSwitch> &&
               !std::is_same_v<Kind, scene::ToolForce> &&
               !std::is_same_v<Kind, scene::PayloadScale> && !std::is_same_v<Kind, scene::OwnMap>;
      },
      sensor.kind);
}

/// Returns an error of a sensor.
Fault error(const scene::Sensor& sensor, const std::string& value, const std::string& rule,
            const std::string& remedy) {
  return {Fault::Severity::kError,
          sensor.file,
          sensor.line,
          "sensor[" + sensor.name + "]",
          value,
          rule,
          remedy};
}

/// Appends what is wrong with the times of a sensor in a world with steps of `dt` [s].
void check_times(const scene::Sensor& sensor, double dt, std::vector<Fault>& faults) {
  // Rounding of the step must not refuse a sensor at the rate of the steps.
  if (sensor.rate * dt > 1 + 1e-6)
    faults.push_back(
        error(sensor, scene::short_text(sensor.rate),
              "a sensor reads at most once in a step of " + scene::short_text(dt * 1e3, 4) + " ms",
              "give update_rate of at most " + scene::short_text(1 / dt, 6) +
                  ", or a shorter max_step_s in navvy:solver"));
  if (const auto* lidar = std::get_if<scene::Lidar>(&sensor.kind))
    if (lidar->sweep * sensor.rate > 1 + 1e-6)
      faults.push_back(error(sensor, scene::short_text(lidar->sweep),
                             "a sweep must end before the next one begins, after " +
                                 scene::short_text(1 / sensor.rate) + " s",
                             "shorten navvy:sweep_s, or lower update_rate"));
}

/// Returns what is wrong with the sensors of a scene in these surroundings.
std::vector<Fault> check(const scene::Scene& scene, const Surroundings& at) {
  std::vector<Fault> faults;
  for (std::size_t m = 0; m < scene.machines.size(); ++m)
    for (std::size_t l = 0; l < scene.machines[m].machine.links.size(); ++l)
      for (const scene::Sensor& sensor : scene.machines[m].machine.links[l].sensors) {
        check_times(sensor, at.dt, faults);
        if (!needs_view(sensor)) continue;
        const Vec3 p_W = (at.X_WL(m, l) * sensor.X_LS).translation();
        const Enclosure inside = at.around(p_W);
        if (inside.what.empty()) continue;
        faults.push_back(error(
            sensor,
            scene::short_text(p_W.x(), 4) + " " + scene::short_text(p_W.y(), 4) + " " +
                scene::short_text(p_W.z(), 4) + " m",
            "the sensor is inside " + inside.what + " at the start, which hides everything from it",
            "move it out with its <pose>"));
        // Other simulators draw the outsides of bodies only, so their machines may have this; the
        // reader refuses it in files of our own.
        if (inside.machine == static_cast<int>(m))
          faults.back().severity = Fault::Severity::kWarning;
      }
  return faults;
}

/// Returns true if one of the scene's sensors fulfils `condition`.
template <class Condition>
bool any_sensor(const scene::Scene& scene, const Condition& condition) {
  for (const scene::MachineInWorld& placed : scene.machines)
    for (const scene::Link& link : placed.machine.links)
      if (std::any_of(link.sensors.begin(), link.sensors.end(), condition)) return true;
  return false;
}

/// The links of a scene at its start, on its ground.
struct Start {
  explicit Start(const scene::Scene& scene)
      : ground(heightfield::make_ground(scene)), bodies(solid_bodies(scene)) {
    const std::vector<Pose> X_WB = sim::starting_poses(scene, ground);
    for (std::size_t m = 0; m < scene.machines.size(); ++m)
      X_WL.push_back(scene::forward_kinematics(scene.machines[m].machine, X_WB[m], {}));
    for (SolidBody& body : bodies)
      body.place(X_WL[static_cast<std::size_t>(body.machine)][static_cast<std::size_t>(body.link)]);
  }

  heightfield::Ground ground;
  std::vector<SolidBody> bodies;
  std::vector<std::vector<Pose>> X_WL;  ///< poses of the links of each machine in W
};

}  // namespace

std::vector<std::unique_ptr<sim::Sampler>> make_sensors(const sim::World& world) {
  std::vector<std::unique_ptr<sim::Sampler>> out;
  std::shared_ptr<RayScene> scene;
  std::shared_ptr<PictureScene> pictures;
  const auto& machines = world.description().machines;
  for (std::size_t m = 0; m < machines.size(); ++m)
    for (std::size_t l = 0; l < machines[m].machine.links.size(); ++l)
      for (const scene::Sensor& sensor : machines[m].machine.links[l].sensors) {
        // A world without sensors pays nothing.
        if (scene == nullptr) {
          scene = std::make_shared<RayScene>(world);
          pictures = std::make_shared<PictureScene>(world);
        }
        const Mounting at{world, static_cast<int>(m), static_cast<int>(l), sensor, scene, pictures};
        out.push_back(std::make_unique<SensorSampler>(at));
      }
  if (scene == nullptr) return out;
  std::vector<Fault> faults =
      check(world.description(),
            {world.dt(),
             [&](std::size_t m, std::size_t l) {
               return world.machines().at(static_cast<int>(m)).link(static_cast<int>(l)).pose();
             },
             [&](const Vec3& p_W) {
               scene->update();
               return scene->around(p_W);
             }});
  if (std::any_of(faults.begin(), faults.end(),
                  [](const Fault& fault) { return fault.severity == Fault::Severity::kError; }))
    throw InputError(std::move(faults));
  for (const Fault& fault : faults) log_warning(fault.text());
  return out;
}

// Before a run there is no loose soil, so columns are enough.
std::vector<Fault> check_sensors(const scene::Scene& scene) try {
  if (!any_sensor(scene, [](const scene::Sensor&) { return true; })) return {};
  std::optional<Start> start;
  // Ground and triangles take time, which sensors that do not look need not spend.
  if (any_sensor(scene, needs_view)) start.emplace(scene);
  return check(
      scene,
      {sim::starting_step(scene), [&](std::size_t m, std::size_t l) { return start->X_WL[m][l]; },
       [&](const Vec3& p_W) { return around(scene, start->ground, start->bodies, p_W); }});
} catch (const InputError& error) {
  return error.faults();
} catch (const FileError& error) {
  return {{Fault::Severity::kError, scene.file, 0, "", "", error.what(), "restore the file"}};
}

std::vector<SensorOutput> sensor_outputs(const sim::World& world) {
  std::vector<SensorOutput> out;
  const auto& machines = world.description().machines;
  const std::vector<sim::ArrayChannel>& channels = world.arrays().channels();
  for (std::size_t m = 0; m < machines.size(); ++m)
    for (std::size_t l = 0; l < machines[m].machine.links.size(); ++l)
      for (const scene::Sensor& sensor : machines[m].machine.links[l].sensors) {
        SensorOutput one;
        one.machine = static_cast<int>(m);
        one.link = static_cast<int>(l);
        one.description = &sensor;
        one.name = machines[m].name + "/" + sensor.name;
        one.link_name = machines[m].name + "/" + machines[m].machine.links[l].name;
        // The frame distinguishes the arrays of this sensor from others of a similar name.
        for (std::size_t i = 0; i < channels.size(); ++i)
          if (channels[i].frame == one.name)
            one.arrays.push_back(
                {channels[i].name.substr(one.name.size() + 1), static_cast<int>(i)});
        if (!one.arrays.empty()) out.push_back(std::move(one));
      }
  return out;
}

}  // namespace navvy::sensor
