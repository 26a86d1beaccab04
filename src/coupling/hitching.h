// SPDX-License-Identifier: Apache-2.0
// The hitches of a scene, once its machines stand on their ground.
#pragma once

#include <functional>

#include "scene/scene.h"
#include "vehicle/physics_engine.h"

namespace navvy::coupling {

/// Gives them to the engine in the order of the scene, so that both number them alike. `index`: of
/// a machine of the scene in the engine. @throws InputError that names file and line for a closed
/// one whose eye is out of the hook's reach.
void add_hitches(const scene::Scene& scene, vehicle::PhysicsEngine& engine,
                 const std::function<int(int)>& index);

}  // namespace navvy::coupling
