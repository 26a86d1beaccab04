// SPDX-License-Identifier: Apache-2.0
// Factory of a world's physics engine. This header declares the engine's interface without
// including it.
#pragma once

#include <functional>
#include <memory>

#include "core/math.h"
#include "scene/machine.h"

namespace navvy::vehicle {

/// Interface of a physics engine, defined in vehicle/physics_engine.h.
class PhysicsEngine;

/// Function that makes a physics engine without machines, for `gravity` (in the world frame [m/s2])
/// and the contact `materials` of a scene. The world then adds its machines.
///
/// Include vehicle/physics_engine.h wherever a function is converted to this type.
using PhysicsEngineFactory = std::function<std::unique_ptr<PhysicsEngine>(
    const Vec3& gravity, const scene::Materials& materials)>;

}  // namespace navvy::vehicle
