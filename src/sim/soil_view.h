// SPDX-License-Identifier: Apache-2.0
// Measurements of the soil of a world.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "sim/world_measurements.h"

namespace navvy::sim {

struct WorldParts;

/// Reads the soil of a world, as plain values (sim/world_measurements.h).
///
/// A view of one pointer: copy it freely. Valid as long as its world lives. Every function returns
/// a copy.
class SoilView {
 public:
  /// Refers to the parts of a world; World::soil makes it.
  explicit SoilView(const WorldParts& parts) : parts_(&parts) {}

  /// Returns the solver's counters.
  SoilCounts counts() const;
  /// Recounts the soil's mass by place. Costs a pass over the particles.
  MassLedger mass_ledger() const;
  /// Returns the energy account since it was opened or since a snapshot was loaded; nothing if
  /// World::keep_soil_energy has not been called.
  std::optional<SoilEnergy> energy() const;
  /// Returns the active soil, one entry per particle, in a repeatable order. Costs a pass over the
  /// particles.
  std::vector<ActiveParticle> loose_soil() const;
  /// Returns the wall time of the soil's stages [s]: "p2g", "grid", "exchange", ...
  std::vector<std::pair<std::string, double>> stage_times() const;

 private:
  const WorldParts* parts_;
};

}  // namespace navvy::sim
