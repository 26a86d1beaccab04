// SPDX-License-Identifier: Apache-2.0
// Lines of bytes as `--set KEY=VALUE` on one scene, which is then read without its machines: they are other targets'.
#include <cstddef>
#include <cstdint>
#include <sstream>
#include <string>

#include "control/step_kinds.h"
#include "core/error.h"
#include "scene_io/fields.h"
#include "scene_io/overrides.h"
#include "scene_io/world_reader.h"

namespace {

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
<model name="m"><navvy:program><wait><duration_s>1</duration_s></wait></navvy:program></model></world></sdf>)";

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace navvy::scene_io;
  Faults faults;
  const auto document = Document::parse(kScene, "fuzz/scene.sdf", faults);
  Overrides overrides;
  std::istringstream lines(std::string(reinterpret_cast<const char*>(data), size));
  for (std::string line; overrides.set.size() < 16 && std::getline(lines, line);) {
    try {
      overrides.set.push_back(parse_setting(line));
    } catch (const navvy::InputError&) {
    }
  }
  apply_overrides(*document, overrides, faults);
  Element& world = *document->root()->FirstChildElement("world");
  for (const char* kind : {"include", "model"})
    while (Element* machine = world.FirstChildElement(kind)) {
      navvy::Pose X;
      if (Element* pose = machine->FirstChildElement("pose")) read_pose(*pose, X, faults);
      world.DeleteChild(machine);
    }
  read_world(*document, navvy::control::step_kinds(), faults);
  return 0;
}
