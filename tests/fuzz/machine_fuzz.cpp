// SPDX-License-Identifier: Apache-2.0
// Bytes as the elements of Navvy's own in a machine, and as its program: our readers on links and joints that
// libsdformat has read once. They report faults; nothing else may happen.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>

#include "control/step_kinds.h"
#include "scene_io/machine_reader.h"
#include "scene_io/program_reader.h"
#include "scene_io/sdf_rules.h"

namespace {

using namespace navvy::scene_io;

const char* const kHead = "<sdf version=\"1.9\" xmlns:navvy=\"navvy\"><model name=\"m\">";
const char* const kBody = R"(
<link name="a"><inertial><mass>2</mass><inertia><ixx>1</ixx><iyy>1</iyy><izz>1</izz></inertia></inertial></link>
<link name="b"><pose>0 1 0 0 0 0</pose></link><link name="c"><pose>0 -1 0 0 0 0</pose></link><link name="d"/>
<joint name="j" type="revolute"><parent>a</parent><child>b</child><axis><xyz>0 1 0</xyz>
<limit><lower>-1</lower><upper>1</upper></limit></axis></joint>
<joint name="k" type="revolute"><parent>a</parent><child>c</child><axis><xyz>0 1 0</xyz></axis></joint>
<joint name="s" type="prismatic"><parent>b</parent><child>d</child><axis><xyz>1 0 0</xyz></axis></joint>
)";
const char* const kTail = "</model></sdf>";

/// Links and joints, read once.
const navvy::scene::Machine& prepared() {
  static const navvy::scene::Machine machine = [] {
    Faults faults;
    const auto document = Document::parse(std::string(kHead) + kBody + kTail, "fuzz/model.sdf", faults);
    navvy::scene::Machine read = read_machine(*document->root()->FirstChildElement("model"), true, faults);
    if (read.links.size() != 4) std::abort();
    return read;
  }();
  return machine;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  Faults faults;
  const std::string bytes(reinterpret_cast<const char*>(data), size);
  const auto document = Document::parse(kHead + bytes + kBody + kTail, "fuzz/model.sdf", faults);
  if (!document) return 0;
  check_sdf(*document->root(), faults);
  Element* model = document->root()->FirstChildElement("model");
  if (model == nullptr) return 0;
  navvy::scene::Machine machine = prepared();
  read_extensions(*model, names_of(*model), machine, faults);
  navvy::scene::StartGround ground;
  if (Element* program = model->FirstChildElement("navvy:program"))
    read_program(*program, navvy::control::step_kinds(), &machine, &ground, faults);
  // What is let in holds what the parts behind it take for granted.
  if (faults.has_errors()) return 0;
  for (const navvy::scene::Shell& shell : machine.shells)
    for (const auto& triangle : shell.triangles)
      for (const int corner : triangle)
        if (corner < 0 || corner >= static_cast<int>(shell.vertices.size())) __builtin_trap();
  for (const navvy::scene::Wheel& wheel : machine.wheels)
    if (machine.joint_index(wheel.joint) < 0 || !(wheel.radius > 0)) __builtin_trap();
  return 0;
}
