// SPDX-License-Identifier: Apache-2.0
// Masses that entered and left the particles of a solver, for its ledger.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "heightfield/layered_ground.h"
#include "soil/particles/particle.h"

namespace navvy {
class Archive;
}

namespace navvy::soil {

struct Ledger;

/// Entries of the ledger that are not counted from particles, in kMassQuantum per soil, and the ids
/// of particles.
///
/// The ledger is balanced when the change of the columns, plus the particles, plus what left the
/// site, minus what was inserted, is zero for every soil. All of these are integers, so the balance
/// is exact.
class MassRecord {
 public:
  /// Starts without particles on this ground, which must outlive the record. `soils`: their number.
  MassRecord(const heightfield::Ground& ground, std::size_t soils);

  /// Returns an id that no particle had before.
  std::uint32_t new_id() { return next_id_++; }
  /// Adds particles that come from outside.
  /// @throws std::out_of_range for a soil that does not exist.
  void record_inserted(std::span<const Particle> particles);
  /// Subtracts particles that left the site.
  void record_left_site(std::span<const Particle> particles);
  /// Replaces the masses that all particles together must have.
  void set_particles(std::span<const Particle> all);
  void set_particles(std::vector<std::int64_t> masses) { in_particles_ = std::move(masses); }
  /// Returns the masses that every count of the particles must give, one per soil.
  const std::vector<std::int64_t>& in_particles() const { return in_particles_; }

  /// Returns the ledger with these masses of particles.
  Ledger ledger(std::vector<std::int64_t> particles) const;

  /// Visits ids, masses that left and masses that came. The masses in particles follow from the
  /// particles.
  void visit(Archive& a);

 private:
  const heightfield::Ground& ground_;
  std::uint32_t next_id_ = 1;
  std::vector<std::int64_t> left_site_, inserted_, in_particles_;
};

}  // namespace navvy::soil
