// SPDX-License-Identifier: Apache-2.0
// Takes bytes as a scene file for the whole loader, libsdformat included. The scene loads or is
// refused with InputError; a scene that has loaded can be written, and the written text loads.
#include <string>

#include "control/step_kinds.h"
#include "core/error.h"
#include "scene_io/loader.h"
#include "target.h"

NAVVY_FUZZ_TARGET(loader) {
  using namespace navvy;
  const std::string text(reinterpret_cast<const char*>(data), size);
  std::string resolved;
  try {
    scene_io::load_scene_from_string(text, "fuzz/scene.sdf", control::step_kinds(), {}, &resolved);
  } catch (const InputError&) {
    return 0;
  }
  // A run leaves this text beside its results; a fault in it is a crash of this target.
  scene_io::load_scene_from_string(resolved, "fuzz/scene.sdf", control::step_kinds());
  return 0;
}
