// SPDX-License-Identifier: Apache-2.0
// Factory of a world's physics engine. Names the engine's interface without including it.
#pragma once

#include <functional>
#include <memory>

#include "core/math.h"
#include "scene/machine.h"

namespace navvy::vehicle {

class PhysicsEngine;

/// Makes an empty physics engine for `gravity` [m/s2, axes of W] and the contact materials of a
/// scene. The world adds machines to it afterwards. Include vehicle/physics_engine.h where a
/// factory is converted to this type.
using PhysicsEngineFactory = std::function<std::unique_ptr<PhysicsEngine>(
    const Vec3& gravity, const scene::Materials& materials)>;

}  // namespace navvy::vehicle
