// SPDX-License-Identifier: Apache-2.0
// Support areas of wheels and tracks, where the soil's exchange must turn particles into ground.
#pragma once

#include <vector>

#include "scene/machine.h"
#include "soil/exchange/footing.h"
#include "vehicle/engine.h"

namespace navvy::coupling {

/// Appends the support areas of wheel `wheel` of machine `index` of `engine`: its tyres, flattened
/// by `load` [N] as Ruts reports it, or the idler, the rollers and the sprocket of its track. The
/// ground must be there `ready` [s] before they arrive [docs/exchange.md, footings].
void add_footings(const scene::Machine& machine, const vehicle::Engine& engine, int index, int wheel, double load,
                  double ready, std::vector<soil::Footing>& footings);

}  // namespace navvy::coupling
