// SPDX-License-Identifier: Apache-2.0
// Copies the solver's results into sim's own types, so that no client includes a header of `soil`.
#include "sim/soil_view.h"

#include "sim/world_parts.h"

namespace navvy::sim {

// Names differ from the solver's: these are the words of the documentation.
SoilCounts SoilView::counts() const {
  const soil::SolverStats& stats = parts_->soil.stats();
  SoilCounts out;
  out.steps = stats.steps;
  out.particle_steps = stats.particle_steps;
  out.particles = stats.particles;
  out.particles_peak = stats.particles_peak;
  out.rebins = stats.rebins;
  out.activated_columns = stats.activations;
  out.deposited_blocks = stats.deposits;
  out.shell_crossings = stats.shell_crossings;
  return out;
}

MassLedger SoilView::mass_ledger() const {
  // Sum the error before moving the parts out.
  soil::Ledger sums = parts_->soil.ledger();
  const std::int64_t error = sums.error();
  return {std::move(sums.columns), std::move(sums.particles), std::move(sums.left_site),
          std::move(sums.inserted), error};
}

// The solver lists its terms in a fixed order.
std::optional<SoilEnergy> SoilView::energy() const {
  const soil::EnergyAccount* account = parts_->soil.energy();
  if (account == nullptr) return std::nullopt;
  SoilEnergy out;
  soil::report_energy(*account, [&](const char* name, double joule) {
    out.push_back({name, joule});
  });
  return out;
}

std::vector<ActiveParticle> SoilView::loose_soil() const {
  std::vector<ActiveParticle> out;
  // Ordered by the particles' ids, so that sums over the result are bit-identical.
  for (const soil::Particle& p : parts_->soil.particles()) {
    // Particles know their block; the grid knows where the block is on the site.
    const auto [ix, iy] = parts_->soil.grid().column_of(p);
    out.push_back({ix, iy, p.soil, p.mass});
  }
  return out;
}

std::vector<std::pair<std::string, double>> SoilView::stage_times() const {
  return parts_->soil.stage_times();
}

}  // namespace navvy::sim
