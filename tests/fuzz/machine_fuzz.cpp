// SPDX-License-Identifier: Apache-2.0
// Takes bytes as a machine file, here also with a program, for our own readers of the element tree.
// Links and joints are read without libsdformat (sdf_stand_in.cpp). An accepted machine satisfies
// the assumptions of the physics engines.
#include <cmath>
#include <string>

#include "control/step_kinds.h"
#include "paths.h"
#include "scene_io/machine_reader.h"
#include "scene_io/program_reader.h"
#include "scene_io/sdf_rules.h"
#include "target.h"

namespace {

using namespace navvy;

/// File names are relative to this path.
const std::string kName = source_dir() + "/tests/fuzz/files/fuzz.sdf";

void check_shells(const scene::Machine& machine) {
  for (const scene::Shell& shell : machine.shells) {
    fuzz::hold(machine.link_index(shell.link) >= 0);
    for (const auto& triangle : shell.triangles)
      for (const int corner : triangle)
        fuzz::hold(corner >= 0 && corner < static_cast<int>(shell.vertices.size()));
    for (std::size_t n = 0; n < shell.triangles.size(); ++n)
      fuzz::hold(shell.area_vector(n).norm() > 0);
  }
  for (const scene::Bucket& bucket : machine.buckets) {
    fuzz::hold(machine.link_index(bucket.link) >= 0);
    fuzz::hold(std::abs(bucket.opening.norm() - 1) < 1e-6 &&
               std::abs(bucket.cut_direction.norm() - 1) < 1e-6);
  }
  for (const scene::Bed& bed : machine.beds) fuzz::hold(machine.joint_index(bed.joint) >= 0);
}

void check_joints(const scene::Machine& machine) {
  fuzz::hold(machine.joints.size() + 1 == machine.links.size());
  for (const scene::Joint& joint : machine.joints) {
    fuzz::hold(joint.parent >= 0 && joint.parent < joint.child);
    fuzz::hold(std::isfinite(joint.initial));
  }
  for (const scene::Wheel& wheel : machine.wheels)
    fuzz::hold(machine.joint_index(wheel.joint) >= 0 && wheel.radius > 0);
  for (const scene::Cylinder& cylinder : machine.cylinders) {
    fuzz::hold(machine.joint_index(cylinder.joint) >= 0);
    fuzz::hold(machine.link_index(cylinder.base_link) >= 0 &&
               machine.link_index(cylinder.rod_link) >= 0);
    fuzz::hold(cylinder.count > 0 && cylinder.rod < cylinder.bore);
  }
}

}  // namespace

NAVVY_FUZZ_TARGET(machine) {
  const std::string text(reinterpret_cast<const char*>(data), size);
  // loader_fuzz reads shipped machines; here their files would take nearly all of the time.
  if (text.find("model://") != std::string::npos) return 0;
  scene_io::Faults faults;
  const auto document = scene_io::Document::parse(text, kName, faults);
  if (!document || !scene_io::check_root(*document->root(), faults)) return 0;
  scene_io::check_sdf(*document->root(), faults);
  scene_io::Element* model = document->root()->FirstChildElement("model");
  if (model == nullptr) return 0;
  const bool sound = !faults.has_errors();
  const scene::Machine machine = scene_io::read_machine(*model, sound, faults);
  const scene::StartGround ground;
  if (scene_io::Element* program = model->FirstChildElement("navvy:program"))
    scene_io::read_program(*program, control::step_kinds(), &machine, &ground, faults);
  if (faults.has_errors()) return 0;
  check_shells(machine);
  check_joints(machine);
  return 0;
}
