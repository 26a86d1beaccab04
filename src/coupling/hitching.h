// SPDX-License-Identifier: Apache-2.0
// Adds the hitches of a scene to the physics engine, after its machines have been placed on the
// ground.
#pragma once

#include <functional>

#include "scene/scene.h"
#include "vehicle/physics_engine.h"

namespace navvy::coupling {

/// Adds all hitches of the scene to the engine, in the order of the scene, so that both use the
/// same indices. `index` returns the index in the engine for the index of a machine in the scene.
/// @throws InputError with file and line if a closed hitch has its eye too far from its hook, or if
/// the engine cannot couple machines.
void add_hitches(const scene::Scene& scene, vehicle::PhysicsEngine& engine,
                 const std::function<int(int)>& index);

}  // namespace navvy::coupling
