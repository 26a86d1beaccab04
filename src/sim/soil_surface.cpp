// SPDX-License-Identifier: Apache-2.0
#include "sim/soil_surface.h"

#include "sim/terrain_view.h"

namespace navvy::sim {
namespace {

// What an operator sees from the cab.
constexpr heightfield::Surface kSeen = heightfield::Surface::kWithLooseSoil;

}  // namespace

const heightfield::Terrain& SoilSurface::terrain() const {
  if (!view_ || seen_step_ != world_.steps()) {
    view_ = terrain_view(world_, kSeen);
    seen_step_ = world_.steps();
  }
  return *view_;
}

}  // namespace navvy::sim
