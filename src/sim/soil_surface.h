// SPDX-License-Identifier: Apache-2.0
// The terrain of a world as its operators look at it.
#pragma once

#include <cstdint>
#include <optional>

#include "control/surface.h"
#include "heightfield/terrain_view.h"
#include "sim/world.h"

namespace navvy::sim {

/// The terrain with the loose soil on it; soil in the air or in a bucket does not count.
///
/// Takes one view in every step in which it is asked, so it has no memory that a snapshot would need; one look costs a
/// pass over the particles. For one thread.
class SoilSurface final : public control::SurfaceView {
 public:
  /// `world` must outlive it.
  explicit SoilSurface(const World& world) : world_(world) {}
  const heightfield::Terrain& terrain() const override;

 private:
  const World& world_;
  mutable std::optional<heightfield::TerrainView> view_;
  mutable std::uint64_t seen_step_ = 0;
};

}  // namespace navvy::sim
