// SPDX-License-Identifier: Apache-2.0
// Soil that a tool carries above the ground, which the rules of the exchange do
// not see.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "heightfield/layered_ground.h"
#include "soil/exchange/exchange.h"
#include "soil/particles/particle.h"
#include "soil/particles/plan_grid.h"

namespace navvy::soil {

/// Returns one flag per particle: not 0 if a tool carries the particle, or has
/// just dropped it, well above the ground and the soil at rest on it. The
/// motion of such soil is none of the ground below it, which may come to rest
/// meanwhile. `grid`: offset of the particles' blocks relative to the columns.
///
/// A tool is above the ground if all columns under its box, and all particles
/// at rest within a cell of the box in plan, end at least two cells below it.
/// Cost is linear in the number of particles and of columns under tools.
std::vector<std::uint8_t> carried_load(const heightfield::Ground& ground, const PlanGrid& grid,
                                       std::span<const Particle> particles,
                                       std::span<const ToolRegion> tools);

}  // namespace navvy::soil
