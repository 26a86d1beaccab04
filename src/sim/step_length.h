// SPDX-License-Identifier: Apache-2.0
// Base step of a scene's world, known without a device.
#pragma once

#include "scene/scene.h"

namespace navvy::sim {

/// Returns the longest base step that soil and scene allow [s].
double longest_step(const scene::Scene& scene);

/// Returns the base step that a world of the scene starts with [s]: the longest one that is stable
/// and divides the period of the scene's control rate. Not positive, or not finite, for settings
/// that no world can be built from.
double starting_step(const scene::Scene& scene);

}  // namespace navvy::sim
