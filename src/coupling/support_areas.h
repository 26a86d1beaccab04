// SPDX-License-Identifier: Apache-2.0
// Areas of ground that support wheels and tracks. In them, the soil solver must convert particles
// back to columns.
#pragma once

#include <vector>

#include "scene/machine.h"
#include "soil/exchange/support_area.h"
#include "vehicle/physics_engine.h"

namespace navvy::coupling {

/// Appends the support areas of one wheel or track to `support_areas`
/// [docs/exchange.md, support areas]. A wheel has one area per tyre; a track has one for its idler,
/// one for its rollers and one for its sprocket.
///
/// `machine` is the description of the machine, `index` its index in `engine`, and `wheel` the
/// index of the wheel in the machine. `load` [N] is the wheel's averaged load (Ruts::load), which
/// flattens the tyres; it is not used for tracks. The ground must be ready `ready` [s] before the
/// wheel or track arrives.
void add_support_areas(const scene::Machine& machine, const vehicle::PhysicsEngine& engine,
                       int index, int wheel, double load, double ready,
                       std::vector<soil::SupportArea>& support_areas);

}  // namespace navvy::coupling
