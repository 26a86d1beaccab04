// SPDX-License-Identifier: Apache-2.0
// A scene between reading it and building worlds of it.
#pragma once

#include "scene/scene.h"

namespace navvy::python {

/// A scene that was read from a file.
struct SceneData {
  scene::Scene scene;  ///< the scene, with all changes
};

}  // namespace navvy::python
