// SPDX-License-Identifier: Apache-2.0
#include "sensor/make_sensors.h"

#include <string>
#include <utility>

#include "core/error.h"
#include "sensor/camera/picture_scene.h"
#include "sensor/ray_scene.h"
#include "sensor/sensor_output.h"
#include "sensor/sensor_sampler.h"

namespace navvy::sensor {
namespace {

/// Appends what is wrong with a sensor in this world to `faults`. `needs_view`: it needs a free
/// view.
void check(const Mounting& at, bool needs_view, std::vector<Fault>& faults) {
  const scene::Sensor& sensor = at.description;
  const auto add = [&](const std::string& value, const std::string& rule,
                       const std::string& remedy) {
    faults.push_back({Fault::Severity::kError, sensor.file, sensor.line,
                      "sensor[" + sensor.name + "]", value, rule, remedy});
  };
  // Rounding of the step must not refuse a sensor at the rate of the steps.
  if (sensor.rate * at.world.dt() > 1 + 1e-6)
    add(scene::short_text(sensor.rate),
        "a sensor reads at most once in a step of " + scene::short_text(at.world.dt() * 1e3, 4) +
            " ms",
        "give update_rate of at most " + scene::short_text(1 / at.world.dt(), 6) +
            ", or a shorter max_step_s in navvy:solver");
  if (const auto* lidar = std::get_if<scene::Lidar>(&sensor.kind))
    if (lidar->sweep * sensor.rate > 1 + 1e-6)
      add(scene::short_text(lidar->sweep),
          "a sweep must end before the next one begins, after " +
              scene::short_text(1 / sensor.rate) + " s",
          "shorten navvy:sweep_s, or lower update_rate");
  if (!needs_view) return;
  at.scene->update();
  const Vec3 p_W = (at.link_handle().pose() * sensor.X_LS).translation();
  if (const std::string inside = at.scene->around(p_W); !inside.empty())
    add(scene::short_text(p_W.x(), 4) + " " + scene::short_text(p_W.y(), 4) + " " +
            scene::short_text(p_W.z(), 4) + " m",
        "the sensor is inside " + inside + " at the start, which hides everything from it",
        "move it out with its <pose>");
}

}  // namespace

std::vector<std::unique_ptr<sim::Sampler>> make_sensors(const sim::World& world) {
  std::vector<std::unique_ptr<sim::Sampler>> out;
  std::vector<Fault> faults;
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
        auto made = std::make_unique<SensorSampler>(at);
        check(at, made->needs_view(), faults);
        out.push_back(std::move(made));
      }
  if (!faults.empty()) throw InputError(std::move(faults));
  return out;
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
