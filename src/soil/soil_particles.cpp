// SPDX-License-Identifier: Apache-2.0
#include "soil/soil_particles.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "core/archive.h"
#include "core/log.h"
#include "device/device_error.h"

namespace navvy::soil {

static void move_to_cell_block(Particle& p) {
  for (int a = 0; a < 3; ++a) {
    // Most particles lie in their block.
    if (p.x[a] >= 0 && p.x[a] < kBlockCells) continue;
    const int d = static_cast<int>(std::floor(p.x[a] / kBlockCells));
    p.block[a] += d;
    p.x[a] -= static_cast<float>(kBlockCells * d);
  }
}

Particle in_cell_block(Particle p) {
  move_to_cell_block(p);
  return p;
}

SoilParticles::SoilParticles(device::Device& device, const std::array<std::int32_t, 4>& site,
                             const std::vector<SoilRow>& soils, int budget)
    : store_(device, site, soils), soils_(soils.size()), budget_(budget) {}

// After a device failure the store keeps its old contents, and the new particles are on the host.
// Queries and snapshots then use those.
std::vector<Particle> SoilParticles::records() const {
  return unplaced_.empty() ? store_.records() : unplaced_;
}

// Blocks of stored particles are those of their base node; the exchange needs the cell itself.
void SoilParticles::by_cell(std::vector<Particle>& out) const {
  store_.exchange_records(out);
  for (Particle& p : out) move_to_cell_block(p);
}

std::vector<PointMass> SoilParticles::masses_near(const Vec3& low, const Vec3& high) const {
  if (unplaced_.empty()) return store_.masses_near(low, high);
  std::vector<PointMass> out;
  for (const Particle& p : unplaced_) {
    PointMass point;
    for (int a = 0; a < 3; ++a)
      // Present position: the displacement of the current transfer included.
      point.grid[a] =
          kBlockCells * p.block[a] + static_cast<double>(p.x[a]) + static_cast<double>(p.moved[a]);
    point.mass = p.mass;
    out.push_back(point);
  }
  return out;
}

void SoilParticles::places(std::vector<ParticlePlace>& out) const {
  if (unplaced_.empty()) return store_.places(out);
  out.clear();
  for (Particle p : unplaced_) {
    for (int a = 0; a < 3; ++a) p.x[a] += p.moved[a];
    p = in_cell_block(p);
    ParticlePlace place{Vec3::Zero(), p.mass, p.j0, p.id, p.soil};
    for (int a = 0; a < 3; ++a)
      place.grid[a] = kBlockCells * p.block[a] + static_cast<double>(p.x[a]);
    out.push_back(place);
  }
}

std::vector<std::int64_t> SoilParticles::masses() const {
  if (unplaced_.empty()) return store_.masses(soils_);
  std::vector<std::int64_t> out(soils_, 0);
  for (const Particle& p : unplaced_) out[p.soil] += p.mass;
  return out;
}

// Logs once each time the budget is exceeded. The run goes on, more slowly.
void SoilParticles::check_budget(std::size_t particles) {
  const bool over = static_cast<int>(particles) > budget_;
  if (over && !over_budget_)
    log_warning("soil: " + std::to_string(particles) +
                " particles are active, more than the budget of " + std::to_string(budget_));
  over_budget_ = over;
}

void SoilParticles::assign(const std::vector<Particle>& particles) {
  check_budget(particles.size());
  try {
    store_.assign(particles);
  } catch (const device::DeviceError&) {
    unplaced_ = ParticleStore::sorted(particles);
    throw;
  }
  unplaced_.clear();
  blocks_changed_ = true;
  drift_ = 0;
}

void SoilParticles::change(const std::vector<std::uint8_t>& removed,
                           const std::vector<Particle>& added) {
  const auto gone =
      removed.size() - static_cast<std::size_t>(std::count(removed.begin(), removed.end(), 0));
  check_budget(static_cast<std::size_t>(count()) - gone + added.size());
  try {
    store_.change(removed, added);
  } catch (const device::DeviceError&) {
    // The store still has those from before.
    std::vector<Particle> all;
    const std::vector<Particle> before = store_.records();
    for (std::size_t i = 0; i < before.size(); ++i)
      if (removed.empty() || removed[i] == 0) all.push_back(before[i]);
    all.insert(all.end(), added.begin(), added.end());
    unplaced_ = ParticleStore::sorted(std::move(all));
    throw;
  }
  unplaced_.clear();
  blocks_changed_ = true;
  drift_ = 0;
}

std::vector<Particle> SoilParticles::rebin() {
  std::vector<Particle> left = store_.rebin();
  drift_ = 0;
  blocks_changed_ = true;
  return left;
}

void SoilParticles::visit(Archive& a) {
  // Both branches write the same format, so that a run that failed can be inspected and continued
  // on another device.
  if (!a.loading() && !unplaced_.empty())
    ParticleStore::visit(a, unplaced_, soils_);
  else
    store_.visit(a);
  if (a.loading()) unplaced_.clear();
  a("blocks_changed", blocks_changed_);
  a("drift", drift_);
  a.require(std::isfinite(drift_) && drift_ >= 0, "drift", "must be finite and not negative");
}

}  // namespace navvy::soil
