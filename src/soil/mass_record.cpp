// SPDX-License-Identifier: Apache-2.0
#include "soil/mass_record.h"

#include <cstdlib>
#include <utility>

#include "core/archive.h"
#include "soil/solver.h"

namespace navvy::soil {

std::int64_t Ledger::error() const {
  std::int64_t sum = 0;
  for (std::size_t i = 0; i < columns.size(); ++i)
    // All terms are integers in mass quanta, so a closed ledger has an error of exactly zero.
    sum += std::abs(columns[i] + particles[i] + left_site[i] - inserted[i]);
  return sum;
}

MassRecord::MassRecord(const heightfield::Ground& ground, std::size_t soils)
    : ground_(ground), left_site_(soils, 0), inserted_(soils, 0), in_particles_(soils, 0) {}

void MassRecord::record_inserted(std::span<const Particle> particles) {
  for (const Particle& p : particles) inserted_.at(p.soil) += p.mass;
}

void MassRecord::record_left_site(std::span<const Particle> particles) {
  for (const Particle& p : particles) {
    left_site_[p.soil] += p.mass;
    // The count of the next transfer must already be without them.
    in_particles_[p.soil] -= p.mass;
  }
}

void MassRecord::set_particles(std::span<const Particle> all) {
  in_particles_.assign(in_particles_.size(), 0);
  for (const Particle& p : all) in_particles_[p.soil] += p.mass;
}

Ledger MassRecord::ledger(std::vector<std::int64_t> particles) const {
  Ledger out;
  out.columns = ground_.mass_change();
  // The ground counts only the soils that it has held.
  out.columns.resize(in_particles_.size(), 0);
  out.particles = std::move(particles);
  out.left_site = left_site_;
  out.inserted = inserted_;
  return out;
}

// in_particles_ is not visited: it follows from the particles.
void MassRecord::visit(Archive& a) {
  a("next_id", next_id_);
  a.fixed("left_site", left_site_);
  a.fixed("inserted", inserted_);
}

}  // namespace navvy::soil
