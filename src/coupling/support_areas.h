// SPDX-License-Identifier: Apache-2.0
// Wheels and belts as the soil's exchange asks for them: where awake soil must become ground.
#pragma once

#include <vector>

#include "scene/machine.h"
#include "soil/exchange/support_area.h"
#include "vehicle/physics_engine.h"

namespace navvy::coupling {

/// Adds the tyres of wheel `wheel` of machine `index` of `engine`, pressed flat by `load` [N] as
/// ruts count it, or the idler, the rollers and the sprocket of its belt. The ground must be there
/// `ready` [s] before them [docs/exchange.md, footings].
void add_support_areas(const scene::Machine& machine, const vehicle::PhysicsEngine& engine,
                       int index, int wheel, double load, double ready,
                       std::vector<soil::SupportArea>& support_areas);

}  // namespace navvy::coupling
