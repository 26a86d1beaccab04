// SPDX-License-Identifier: Apache-2.0
// Support areas of wheels and tracks, where the soil's exchange must turn particles into ground.
#pragma once

#include <vector>

#include "scene/machine.h"
#include "soil/exchange/support_area.h"
#include "vehicle/physics_engine.h"

namespace navvy::coupling {

/// Appends the support areas of wheel `wheel` of machine `index` of `engine`: its tyres, flattened
/// by `load` [N] as Ruts reports it, or the idler, the rollers and the sprocket of its track. The
/// ground must be there `ready` [s] before they arrive [docs/exchange.md, support areas].
void add_support_areas(const scene::Machine& machine, const vehicle::PhysicsEngine& engine,
                       int index, int wheel, double load, double ready,
                       std::vector<soil::SupportArea>& support_areas);

}  // namespace navvy::coupling
