// SPDX-License-Identifier: Apache-2.0
// The smallest physics engine that fulfils the contract.
#pragma once

#include <memory>

#include "vehicle/physics_engine_factory.h"

namespace example {

/// Makes an engine whose machines are one body each, moved as a particle: it falls, slides with
/// friction on level ground and never turns. Has no optional capability.
std::unique_ptr<navvy::vehicle::PhysicsEngine> make_particle_engine(
    const navvy::Vec3& gravity, const navvy::scene::Materials& materials);

}  // namespace example
