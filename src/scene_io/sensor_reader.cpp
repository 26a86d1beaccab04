// SPDX-License-Identifier: Apache-2.0
#include "scene_io/sensor_reader.h"

#include <algorithm>
#include <filesystem>
#include <set>

#include "scene_io/mesh_path.h"
#include "scene_io/sdf_rules.h"
#include "scene_io/shipped_files.h"

namespace navvy::scene_io {

namespace fs = std::filesystem;

namespace {

/// Sensors of SDF that are not simulated: a file that has them still runs.
const std::set<std::string>& ignored_types() {
  static const std::set<std::string> types = {"air_pressure",
                                              "air_speed",
                                              "altimeter",
                                              "boundingbox",
                                              "boundingbox_camera",
                                              "custom",
                                              "force_torque",
                                              "logical_camera",
                                              "magnetometer",
                                              "multicamera",
                                              "rfid",
                                              "rfidtag",
                                              "rgbd",
                                              "rgbd_camera",
                                              "thermal",
                                              "thermal_camera",
                                              "wideanglecamera",
                                              "wireless_receiver",
                                              "wireless_transmitter"};
  return types;
}

/// Reports a type of noise that is not one of SDF's, at the sensor's element.
void check_noise(const Element& sensor, const scene::SensorNoise& noise, Faults& faults) {
  if (noise.type == "none" || noise.type == "gaussian" || noise.type == "gaussian_quantized")
    return;
  faults.error(sensor, noise.type,
               "the type of a noise must be none, gaussian or "
               "gaussian_quantized",
               faults.nearest(noise.type, {"none", "gaussian", "gaussian_quantized"}));
}

void check_range(const Element& at, double min, double max, Faults& faults) {
  if (min < max) return;
  faults.error(at, scene::short_text(min) + " to " + scene::short_text(max),
               "the smallest distance must be below the largest", "exchange them");
}

void check_fan(const Element& at, const char* name, const scene::BeamFan& fan, Faults& faults) {
  if (fan.min_angle <= fan.max_angle) return;
  faults.error(at, scene::short_text(fan.min_angle) + " to " + scene::short_text(fan.max_angle),
               std::string("min_angle must not exceed max_angle in <") + name + ">",
               "exchange them; angles grow to the left and upwards");
}

void check_count(const Element& at, double beams, Faults& faults) {
  if (beams <= scene::kMostBeams) return;
  faults.error(at, scene::short_text(beams),
               "a sensor has at most " + scene::short_text(scene::kMostBeams) + " beams",
               "use fewer samples, rings or pixels");
}

/// Checks the parts of a sensor that depend on its kind.
struct KindRules {
  const Element& at;
  const Element& link;
  const scene::Machine& machine;
  Faults& faults;

  void noise(const scene::SensorNoise& one) const { check_noise(at, one, faults); }
  void noise(const scene::NoiseOfVector& three) const {
    for (const auto* value : {&three.x, &three.y, &three.z}) noise(value->noise);
  }
  void operator()(const scene::Lidar& lidar) const {
    check_fan(at, "horizontal", lidar.horizontal, faults);
    check_fan(at, "vertical", lidar.vertical, faults);
    check_range(at, lidar.range.min, lidar.range.max, faults);
    check_count(at, 1.0 * lidar.horizontal.samples * lidar.vertical.samples, faults);
    noise(lidar.noise);
  }
  void operator()(const scene::Sonar& sonar) const {
    if (sonar.geometry != "cone")
      faults.error(at, sonar.geometry, "the beam of a sonar must be a cone", "write cone");
    check_range(at, sonar.min, sonar.max, faults);
    noise(sonar.noise);
  }
  void operator()(const scene::Infrared& infrared) const {
    check_range(at, infrared.range.min, infrared.range.max, faults);
    noise(infrared.noise);
  }
  void operator()(const scene::TimeOfFlight& camera) const {
    check_range(at, camera.range.min, camera.range.max, faults);
    check_count(at, 1.0 * camera.width * camera.height * camera.rays * camera.rays, faults);
    noise(camera.noise);
  }
  void operator()(const scene::Imu& imu) const {
    noise(imu.angular_velocity);
    noise(imu.linear_acceleration);
  }
  void operator()(const scene::Gnss& gnss) const {
    for (const auto* sensing : {&gnss.position, &gnss.velocity}) {
      noise(sensing->horizontal.noise);
      noise(sensing->vertical.noise);
    }
  }
  void operator()(const scene::JointGauge& gauge) const {
    for (const auto* value : {&gauge.position, &gauge.velocity, &gauge.effort}) noise(value->noise);
    const int joint = machine.joint_index(gauge.joint);
    if (joint < 0) return;
    const auto type = machine.joints[static_cast<std::size_t>(joint)].type;
    if (type != scene::Joint::Type::kRevolute && type != scene::Joint::Type::kPrismatic)
      faults.error(at, gauge.joint, "only revolute and prismatic joints have a position",
                   "name another joint");
  }
  void operator()(const scene::CylinderPressure& gauge) const {
    noise(gauge.pressure);
    noise(gauge.length);
    if (!gauge.cylinder.empty())
      require_name(at, gauge.cylinder, "navvy:cylinder of this name in the model",
                   names_in_list(machine.cylinders), faults);
  }
  void operator()(const scene::ContactSwitch& contact) const {
    std::vector<std::string> names;
    for (const Element* e = link.FirstChildElement("collision"); e;
         e = e->NextSiblingElement("collision"))
      names.push_back(attribute(*e, "name"));
    // A sensor of the scene stands in no <link>.
    if (!contact.collision.empty() && &link != &at)
      require_name(at, contact.collision, "collision of this name in the link", names, faults);
  }
  void operator()(const scene::ToolForce& gauge) const {
    noise(gauge.force);
    noise(gauge.moment);
  }
  void operator()(const scene::PayloadScale& scale) const { noise(scale.noise); }
  void operator()(const scene::DepthCamera& camera) const {
    check_range(at, camera.near, camera.far, faults);
    check_count(at, 1.0 * camera.width * camera.height, faults);
    noise(camera.noise);
  }
  void operator()(const scene::ColourCamera& camera) const {
    check_count(at, 1.0 * camera.width * camera.height, faults);
    noise(camera.noise);
  }
  void operator()(const scene::OwnMap& map) const {
    if (!map.has_area) return;
    if ((map.min.array() >= map.max.array()).any())
      faults.error(at, scene::short_text(map.min.x()) + " " + scene::short_text(map.min.y()),
                   "min_m must be below max_m", "exchange them");
    else if (map.cell > 0)
      check_count(at, (map.max - map.min).prod() / (map.cell * map.cell), faults);
  }
};

/// Returns true if the point `p` of a shape's frame is inside the shape. A mesh has no formula; the
/// start of a run checks it.
bool contains(const scene::Geometry& shape, const Vec3& p) {
  using Kind = scene::Geometry::Kind;
  const double radial = p.head<2>().norm(), along = std::abs(p.z()), half = 0.5 * shape.length;
  switch (shape.kind) {
    case Kind::kBox:
      return (p.cwiseAbs().array() < 0.5 * shape.size.array()).all();
    case Kind::kCylinder:
      return radial < shape.radius && along < half;
    case Kind::kSphere:
      return p.norm() < shape.radius;
    case Kind::kCone:
      return along < half && radial < shape.radius * (half - p.z()) / shape.length;
    case Kind::kCapsule:
      return std::hypot(radial, std::max(0.0, along - half)) < shape.radius;
    case Kind::kMesh:
    case Kind::kPlane:
      break;
  }
  return false;
}

/// Beams that start inside a solid would see its inside.
void check_place(const Element& at, const scene::Link& link, const scene::Sensor& sensor,
                 const scene::Machine& machine, Faults& faults) {
  const bool looks = !std::holds_alternative<scene::Imu>(sensor.kind) &&
                     !std::holds_alternative<scene::JointGauge>(sensor.kind) &&
                     !std::holds_alternative<scene::CylinderPressure>(sensor.kind) &&
                     !std::holds_alternative<scene::ContactSwitch>(sensor.kind) &&
                     !std::holds_alternative<scene::ToolForce>(sensor.kind) &&
                     !std::holds_alternative<scene::PayloadScale>(sensor.kind) &&
                     !std::holds_alternative<scene::OwnMap>(sensor.kind);
  if (!looks) return;
  const Vec3 p_M = link.X_ML * sensor.X_LS.translation();
  for (const scene::Link& body : machine.links)
    for (const scene::Visual& visual : body.visuals)
      if (contains(visual.geometry, (body.X_ML * visual.X_LV).inverse() * p_M)) {
        const Element& pose = child_or_self(at, "pose");
        const std::string rule = "the sensor is inside the visual '" + visual.name + "' of link '" +
                                 body.name + "', which hides everything from it";
        // Other simulators draw the outsides of bodies only, so their files may have this.
        if (Document::of(at).foreign())
          faults.warning(pose, text_of(pose), rule, "move it out with its <pose>");
        else
          faults.error(pose, text_of(pose), rule, "move it out with its <pose>");
        return;
      }
}

/// Checks one sensor, which was read from `at`, and adds it to a link of the machine. `link` is the
/// element of that link, or `at` for a sensor of the scene. `seen` holds the names so far.
void place_sensor(const Element& at, const Element& link, int index, scene::Sensor sensor,
                  scene::Machine& machine, std::set<std::string>& seen, Faults& faults) {
  if (!sensor.name.empty() && !seen.insert(sensor.name).second)
    faults.error(at, sensor.name, "names of sensors must be unique in a machine",
                 "rename one of them");
  // Names are parts of the names of outputs and of folders.
  if (sensor.name.find('/') != std::string::npos || sensor.name.rfind('.', 0) == 0)
    faults.error(at, sensor.name, "must not contain '/' nor begin with '.'", "rename it");
  std::visit(KindRules{at, link, machine, faults}, sensor.kind);
  const Place place = place_of(at);
  sensor.file = place.file != nullptr ? *place.file : "";
  sensor.line = place.line;
  if (const Element* pose = at.FirstChildElement("pose"))
    if (pose->Attribute("relative_to"))
      faults.error(*pose, attribute(*pose, "relative_to"),
                   "the pose of a sensor is relative to its link", "remove relative_to");
  if (index < 0 || faults.has_fault(at)) return;
  scene::Link& carrier = machine.links[static_cast<std::size_t>(index)];
  check_place(at, carrier, sensor, machine, faults);
  carrier.sensors.push_back(std::move(sensor));
  if (carrier.sensors.size() == scene::kMostSensors + 1)
    faults.error(at, "", "a link has at most " + std::to_string(scene::kMostSensors) + " sensors",
                 "remove some");
}

/// Reads one sensor; returns false for one that is ignored.
bool read_sensor(Element& element, const Names& names, scene::Sensor& sensor, Faults& faults) {
  const std::string type = attribute(element, "type");
  if (ignored_types().count(type) > 0) {
    faults.warning(element, type, "sensors of this type are ignored",
                   "`navvy schema sensor` lists those that are simulated");
    return false;
  }
  fill_in_preset(element, faults);
  if (attribute(element, "type").empty())
    faults.error(element, "", "needs an attribute type=\"...\"", "e.g. lidar, or name a preset");
  read_element(element, sensor, &names, faults);
  return true;
}

}  // namespace

void fill_in_preset(Element& sensor, Faults& faults) {
  const Element* named = sensor.FirstChildElement("navvy:preset");
  if (named == nullptr || text_of(*named).empty()) return;
  const std::string name = text_of(*named),
                    file = data_file(Document::of(sensor).directory(), name, "sensors");
  std::error_code ignored;
  if (file.empty() || !fs::is_regular_file(file, ignored)) {
    faults.error(*named, name, "no such preset of a sensor",
                 faults.nearest(name, shipped_files("sensors")));
    return;
  }
  const auto document = Document::open(file, faults);
  if (!document || !check_root(*document->root(), faults)) return;
  const Element* preset = document->root()->FirstChildElement("sensor");
  if (preset == nullptr) {
    faults.error(*document->root(), "", "the file of a preset needs a <sensor>", "add it");
    return;
  }
  const std::string type = attribute(*preset, "type");
  if (attribute(sensor, "type").empty()) sensor.SetAttribute("type", type.c_str());
  if (attribute(sensor, "type") != type) {
    faults.error(*named, name, "this preset is of the type " + type,
                 "remove the attribute type, or name another preset");
    return;
  }
  add_missing(sensor, *preset);
}

void read_sensors(Element& model, const Names& names, scene::Machine& machine, Faults& faults) {
  std::set<std::string> seen;
  for (Element* link : children_of(model, {"link"}))
    for (Element* element : children_of(*link, {"sensor"})) {
      scene::Sensor sensor;
      if (!read_sensor(*element, names, sensor, faults)) continue;
      if (element->Attribute("link"))
        faults.error(*element, sensor.link, "the link around a <sensor> carries it",
                     "remove the attribute link");
      place_sensor(*element, *link, machine.link_index(attribute(*link, "name")), std::move(sensor),
                   machine, seen, faults);
    }
}

void add_sensors(Element& element, scene::MachineInWorld& instance, Faults& faults) {
  scene::Machine& machine = instance.machine;
  std::set<std::string> seen;
  for (const scene::Link& link : machine.links)
    for (const scene::Sensor& sensor : link.sensors) seen.insert(sensor.name);
  std::size_t i = 0;
  for (Element* at : children_of(element, {"navvy:sensor"})) {
    const scene::Sensor& sensor = instance.sensors.at(i++);
    // A machine without links has faults of its own.
    if (machine.links.empty()) continue;
    const std::string link = sensor.link.empty() ? machine.links.front().name : sensor.link;
    require_name(*at, link, "link of this name in the machine", names_in_list(machine.links),
                 faults);
    place_sensor(*at, *at, machine.link_index(link), sensor, machine, seen, faults);
  }
}

}  // namespace navvy::scene_io
