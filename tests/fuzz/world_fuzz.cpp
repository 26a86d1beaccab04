// SPDX-License-Identifier: Apache-2.0
// A scene file, read by our own readers on its element tree; models without libsdformat
// (sdf_stand_in.cpp). It is refused with a list of faults, or what it became can be written out,
// read again as the same scene, and laid out as ground.
#include <string>

#include "control/step_kinds.h"
#include "core/error.h"
#include "heightfield/make_ground.h"
#include "paths.h"
#include "scene/parameters.h"
#include "scene_io/resolved.h"
#include "scene_io/world_reader.h"
#include "target.h"

namespace {

using namespace navvy;

/// Files are named from there.
const std::string kName = source_dir() + "/tests/fuzz/files/fuzz.sdf";

/// Far above this, time goes into columns and no longer into what is read.
constexpr double kMostColumns = 10'000;

scene::Scene read(scene_io::Document& document, scene_io::Faults& faults) {
  scene_io::check_resolved(document, faults);
  return scene_io::read_world(document, control::step_kinds(), faults);
}

void lay_out(const scene::Scene& world) {
  const Vec2 cells = world.ground.size / world.solver.cell;
  if (cells.prod() > kMostColumns || !world.ground.file.empty()) return;
  try {
    const heightfield::Ground ground = heightfield::make_ground(world);
    for (int iy = 0; iy < ground.ny(); ++iy)
      for (int ix = 0; ix < ground.nx(); ++ix) fuzz::hold(ground.height(ix, iy) >= ground.datum());
  } catch (const InputError&) {
    // Such as a trench below the bedrock.
  }
}

}  // namespace

NAVVY_FUZZ_TARGET(world) {
  const std::string text(reinterpret_cast<const char*>(data), size);
  // Shipped machines are read in loader_fuzz; here their files would take nearly all of the time.
  if (text.find("model://") != std::string::npos) return 0;
  scene_io::Faults faults;
  const auto document = scene_io::Document::parse(text, kName, faults);
  if (!document) return 0;
  const scene::Scene world = read(*document, faults);
  for (const Fault& fault : faults.list()) fuzz::hold(!fault.text().empty());
  if (faults.has_errors()) return 0;
  lay_out(world);
  scene_io::Faults again_faults;
  const auto again =
      scene_io::Document::parse(scene_io::resolved_text(*document, world), kName, again_faults);
  fuzz::hold(again != nullptr);
  const scene::Scene twin = read(*again, again_faults);
  fuzz::hold(!again_faults.has_errors());
  fuzz::hold(scene::parameters(world) == scene::parameters(twin));
  return 0;
}
