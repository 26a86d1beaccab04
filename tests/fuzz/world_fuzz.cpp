// SPDX-License-Identifier: Apache-2.0
// Bytes as a scene file, read by the whole loader with libsdformat. A scene loads or is refused with InputError; what
// has loaded can be written out and read again.
#include <cstddef>
#include <cstdint>
#include <string>

#include "control/step_kinds.h"
#include "core/error.h"
#include "scene_io/loader.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(reinterpret_cast<const char*>(data), size);
  const auto& kinds = navvy::control::step_kinds();
  std::string resolved;
  try {
    navvy::scene_io::load_scene_from_string(text, "fuzz/scene.sdf", kinds, {}, &resolved);
  } catch (const navvy::InputError&) {
    return 0;
  }
  // What a run leaves beside its results is a scene that loads.
  navvy::scene_io::load_scene_from_string(resolved, "fuzz/scene.sdf", kinds);
  return 0;
}
