// SPDX-License-Identifier: Apache-2.0
// Record of the masses that entered and left the particles of a solver, for its mass ledger.
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

/// Records inserted and lost masses, the total mass of the particles, and the next free particle
/// ID. All masses are integers, one entry per soil, in units of kMassQuantum.
///
/// The ledger is balanced when, for every soil, the change of the columns + the mass of the
/// particles + the mass that left the site - the mass inserted is zero. All terms are integers, so
/// the balance is exact.
class MassRecord {
 public:
  /// Starts without particles. `ground` must outlive the record; `soils`: number of soils of the
  /// scene.
  MassRecord(const heightfield::Ground& ground, std::size_t soils);

  /// Returns an ID that no particle had before.
  std::uint32_t new_id() { return next_id_++; }
  /// Records the mass of particles that are inserted from outside the simulation.
  /// @throws std::out_of_range for a soil index that does not exist.
  void record_inserted(std::span<const Particle> particles);
  /// Records the mass of particles that left the site, and subtracts it from in_particles().
  void record_left_site(std::span<const Particle> particles);
  /// Sets in_particles() to the sum over all particles.
  void set_particles(std::span<const Particle> all);
  /// Sets in_particles() to these masses, one entry per soil.
  void set_particles(std::vector<std::int64_t> masses) { in_particles_ = std::move(masses); }
  /// Returns the mass that all particles together must have. check_masses compares it with the
  /// masses counted on the device.
  const std::vector<std::int64_t>& in_particles() const { return in_particles_; }

  /// Returns the complete ledger. `particles`: counted particle mass, one entry per soil.
  Ledger ledger(std::vector<std::int64_t> particles) const;

  /// Visits the next ID and the masses that left and were inserted. in_particles() is not saved,
  /// because it follows from the particles.
  void visit(Archive& a);

 private:
  /// Ground whose mass change enters the ledger.
  const heightfield::Ground& ground_;
  /// ID of the next new particle.
  std::uint32_t next_id_ = 1;
  /// Masses per soil [kMassQuantum]: left_site_ went over the site's edge, inserted_ came from
  /// outside, in_particles_ is what all particles must sum to.
  std::vector<std::int64_t> left_site_, inserted_, in_particles_;
};

}  // namespace navvy::soil
