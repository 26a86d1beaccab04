// SPDX-License-Identifier: Apache-2.0
// Takes bytes as a URDF file, or as an SDF file of another simulator: the converter reports faults,
// or gives a model that the readers accept or refuse. Links and joints are read without libsdformat
// (sdf_stand_in.cpp).
#include <string>

#include "paths.h"
#include "scene_io/machine_reader.h"
#include "scene_io/sdf_rules.h"
#include "target.h"

NAVVY_FUZZ_TARGET(urdf) {
  using namespace navvy;
  const std::string text(reinterpret_cast<const char*>(data), size);
  // loader_fuzz reads shipped machines; here their files would take nearly all of the time.
  if (text.find("model://") != std::string::npos) return 0;
  scene_io::Faults faults;
  const auto document =
      scene_io::Document::parse(text, source_dir() + "/tests/fuzz/files/fuzz.urdf", faults);
  if (!document) {
    // Whatever is not read is explained.
    fuzz::hold(faults.has_errors());
    return 0;
  }
  if (!scene_io::check_root(*document->root(), faults)) return 0;
  scene_io::check_sdf(*document->root(), faults);
  scene_io::Element* model = document->root()->FirstChildElement("model");
  if (model == nullptr) return 0;
  const scene::Machine machine = scene_io::read_machine(*model, !faults.has_errors(), faults);
  if (faults.has_errors()) return 0;
  fuzz::hold(machine.joints.size() + 1 == machine.links.size());
  for (const scene::Link& link : machine.links) fuzz::hold(link.mass > 0);
  return 0;
}
