// SPDX-License-Identifier: Apache-2.0
// Takes bytes as a scene file for our own readers of the element tree; models are read without
// libsdformat (sdf_stand_in.cpp). The scene is refused with a list of faults, or it can be written,
// is equal when read again, and its ground can be built.
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

/// File names are relative to this path.
const std::string kName = source_dir() + "/tests/fuzz/files/fuzz.sdf";

/// Far above this, columns take the time instead of reading.
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
    // E.g. a trench below the bedrock.
  }
}

}  // namespace

NAVVY_FUZZ_TARGET(world) {
  const std::string text(reinterpret_cast<const char*>(data), size);
  // loader_fuzz reads shipped machines; here their files would take nearly all of the time.
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
