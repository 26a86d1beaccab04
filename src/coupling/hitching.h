// SPDX-License-Identifier: Apache-2.0
// Hitches of a scene, added after its machines stand on the ground.
#pragma once

#include <functional>

#include "scene/scene.h"
#include "vehicle/physics_engine.h"

namespace navvy::coupling {

/// Adds the scene's hitches to the engine in the order of the scene, so that both use the same
/// indices. `index` maps a machine of the scene to its index in the engine.
/// @throws InputError with file and line for a closed hitch whose eye is out of the hook's reach,
/// and for an engine that cannot couple machines.
void add_hitches(const scene::Scene& scene, vehicle::PhysicsEngine& engine,
                 const std::function<int(int)>& index);

}  // namespace navvy::coupling
