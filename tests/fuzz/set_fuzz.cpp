// SPDX-License-Identifier: Apache-2.0
// Takes lines as `--set KEY=VALUE`, and as the other options that change a scene, and reads one
// scene with them. An accepted scene is equal when it is written and read again. Models are read
// without libsdformat (sdf_stand_in.cpp).
#include <sstream>
#include <string>

#include "control/step_kinds.h"
#include "core/error.h"
#include "scene/parameters.h"
#include "scene_io/overrides.h"
#include "scene_io/resolved.h"
#include "scene_io/world_reader.h"
#include "target.h"

namespace {

using namespace navvy;

const char* const kScene = R"(<sdf version="1.9" xmlns:navvy="navvy"><world name="w">
<navvy:soil name="fill"><cohesion_pa>1000</cohesion_pa><friction_angle_deg>30</friction_angle_deg></navvy:soil>
<navvy:soil name="sand"><cohesion_pa>0</cohesion_pa></navvy:soil>
<navvy:ground><size_m>24 20</size_m><layer><soil>fill</soil><thickness_m>1</thickness_m></layer>
<layer><soil>sand</soil></layer><hills><height_m>0.4</height_m></hills><hills><height_m>0.1</height_m></hills>
<patch><min_m>1 2</min_m><max_m>3 4</max_m><layer><soil>sand</soil></layer></patch></navvy:ground>
<navvy:solver><cell_m>0.2</cell_m></navvy:solver><navvy:camera name="still"><position_m>1 2 3</position_m></navvy:camera>
<include><uri>model://ew180</uri><pose degrees="true">1 2 0 0 0 90</pose></include>
<include><uri>model://dumper/</uri><name>truck</name>
<pose rotation_format="quat_xyzw">1 2 0 0 0 0.6 0.8</pose></include>
<model name="m"><link name="a"><inertial><mass>9</mass><inertia><ixx>1</ixx><iyy>1</iyy><izz>1</izz></inertia></inertial>
</link><link name="b"><inertial><mass>1</mass></inertial></link><joint name="j" type="revolute"><parent>a</parent>
<child>b</child><axis><xyz>0 1 0</xyz></axis></joint><navvy:joint name="j"><initial_deg>3</initial_deg></navvy:joint>
<navvy:program><wait><duration_s>1</duration_s></wait></navvy:program></model></world></sdf>)";

/// Applies a line: a line with the name of an option is that option, any other line is a setting.
void take(const std::string& line, scene_io::Overrides& overrides) {
  const auto [key, value] = scene_io::parse_setting(line);
  std::istringstream in(value);
  double x = 0, y = 0;
  if (key == "seed") {
    overrides.seed = std::strtoull(value.c_str(), nullptr, 10);
  } else if (key == "render") {
    overrides.render = value == "true";
  } else if (key == "duration" && in >> x) {
    overrides.duration = x;
  } else if (key == "terrain") {
    overrides.terrain = value;
  } else if ((key == "at" || key == "at_local") && in >> x >> y) {
    overrides.at = Vec2(x, y);
    overrides.at_is_local = key == "at_local";
  } else if (key == "size" && in >> x >> y) {
    overrides.size = Vec2(x, y);
  } else {
    overrides.set.emplace_back(key, value);
  }
}

}  // namespace

NAVVY_FUZZ_TARGET(set) {
  scene_io::Overrides overrides;
  std::istringstream lines(std::string(reinterpret_cast<const char*>(data), size));
  int taken = 0;
  for (std::string line; taken < 16 && std::getline(lines, line); ++taken) {
    try {
      take(line, overrides);
    } catch (const InputError&) {
      // The line has no '='.
    }
  }
  scene_io::Faults faults;
  const auto document = scene_io::Document::parse(kScene, "fuzz/scene.sdf", faults);
  scene_io::apply_overrides(*document, overrides, faults);
  // world_fuzz reads machines of other files; here their files would take nearly all of the time.
  scene_io::Element& world = *document->root()->FirstChildElement("world");
  while (scene_io::Element* include = world.FirstChildElement("include"))
    world.DeleteChild(include);
  const scene::Scene scene = scene_io::read_world(*document, control::step_kinds(), faults);
  for (const Fault& fault : faults.list()) fuzz::hold(!fault.text().empty());
  if (faults.has_errors()) return 0;
  scene_io::Faults again_faults;
  const auto again = scene_io::Document::parse(scene_io::resolved_text(*document, scene),
                                               "fuzz/scene.sdf", again_faults);
  fuzz::hold(again != nullptr);
  const scene::Scene twin = scene_io::read_world(*again, control::step_kinds(), again_faults);
  fuzz::hold(!again_faults.has_errors() && scene::parameters(scene) == scene::parameters(twin));
  return 0;
}
