// SPDX-License-Identifier: Apache-2.0
// libFuzzer entry: bytes as a scene file. A scene loads or is refused with InputError; nothing else may happen.
#include <cstddef>
#include <cstdint>
#include <string>

#include "control/step_kinds.h"
#include "core/error.h"
#include "scene_io/loader.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(reinterpret_cast<const char*>(data), size);
  try {
    navvy::scene_io::load_scene_from_string(text, "fuzz/scene.sdf", navvy::control::step_kinds());
  } catch (const navvy::InputError&) {
  }
  return 0;
}
