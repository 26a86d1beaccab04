// SPDX-License-Identifier: Apache-2.0
// Measurements of a world's soil.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "sim/world_measurements.h"

namespace navvy::sim {

struct WorldParts;

/// Reads measurements of a world's soil as plain values (sim/world_measurements.h).
///
/// An object of this class is a pointer to its world: it is cheap to copy and valid as long as the
/// world exists. Every function returns a copy of the data.
class SoilView {
 public:
  /// Creates a view of the world that owns `parts`. Clients call World::soil instead.
  explicit SoilView(const WorldParts& parts) : parts_(&parts) {}

  /// Returns the counters of the soil solver, such as the number of particles.
  SoilCounts counts() const;
  /// Returns the soil mass in columns, in particles, and lost over the edge. The masses are summed
  /// anew, which costs a pass over all particles.
  MassLedger mass_ledger() const;
  /// Returns the energy account since it was started (World::keep_soil_energy) or since a snapshot
  /// was loaded, whichever came last. Returns nothing if the account was never started.
  std::optional<SoilEnergy> energy() const;
  /// Returns all active particles as masses above ground columns, in an order that is the same in
  /// every repetition of a run. Costs a pass over all particles.
  std::vector<ActiveParticle> loose_soil() const;
  /// Returns pairs of stage name ("p2g", "grid", "exchange", ...) and wall time that the soil
  /// solver has spent in that stage so far [s].
  std::vector<std::pair<std::string, double>> stage_times() const;

 private:
  const WorldParts* parts_;
};

}  // namespace navvy::sim
