// SPDX-License-Identifier: Apache-2.0
// The particles of a solver: the store on the device, and the drift of the particles since their
// last re-bin.
#pragma once

#include <cstdint>
#include <vector>

#include "soil/particles/particle_store.h"

namespace navvy {
class Archive;
}

namespace navvy::soil {

/// Drift of the particles since the last re-bin above which they are re-binned before the next
/// transfer [cells]. The tile of a block has a margin of one cell; the difference covers one push
/// out of a plate.
inline constexpr double kMaxDrift = 0.75;

/// Returns the particle assigned to the block that contains its position. The store assigns
/// particles to the block of their base node instead, half a cell lower.
Particle in_cell_block(Particle p);

/// All particles of a solver, on the device. If the device has no memory for them, the run ends
/// with an error, but the particles remain available on the host, so that ledger and snapshot stay
/// complete.
///
/// `assign`, `rebin` and loading a state change the set of blocks. blocks_changed() then returns
/// true until the solver has rebuilt its lists and called clear_blocks_changed().
class SoilParticles {
 public:
  /// Creates an empty set. `site`, `soils`: see ParticleStore. `budget`: number of particles above
  /// which a warning is logged.
  SoilParticles(device::Device& device, const std::array<std::int32_t, 4>& site,
                const std::vector<SoilRow>& soils, int budget);

  /// Returns the particles on the device.
  ParticleStore& store() { return store_; }
  /// Returns the particles on the device.
  const ParticleStore& store() const { return store_; }
  /// Returns the number of particles on the device.
  int count() const { return store_.count(); }

  /// Returns host copies of all particles, in stored order.
  std::vector<Particle> records() const;
  /// Replaces the contents of `out` by host copies of the particles on the device, in stored order,
  /// each assigned to the block that contains its position (in_cell_block), with the fields that
  /// ParticleStore::exchange_records reads.
  void by_cell(std::vector<Particle>& out) const;
  /// Returns the current positions and masses of all particles inside the box `low` .. `high` of G
  /// [cells], and of some outside it.
  std::vector<PointMass> masses_near(const Vec3& low, const Vec3& high) const;
  /// Replaces the contents of `out` by the places of all particles, in stored order.
  void places(std::vector<ParticlePlace>& out) const;
  /// Returns the total particle mass, one entry per soil [kMassQuantum].
  std::vector<std::int64_t> masses() const;

  /// Replaces all particles. Logs a warning when their number first exceeds the budget.
  /// @throws device::DeviceError when the device has no memory for them; they are then kept on the
  /// host.
  void assign(const std::vector<Particle>& particles);
  /// Removes the particles whose flag in `removed` is not 0, and adds `added`
  /// (ParticleStore::change). Logs the warning and keeps particles on the host as `assign` does.
  void change(const std::vector<std::uint8_t>& removed, const std::vector<Particle>& added);
  /// Sorts the particles into the blocks of their current positions. Removes those that left the
  /// site and returns them.
  std::vector<Particle> rebin();
  /// Returns true if particles may leave the tile of their block during the next transfer.
  bool rebin_due() const { return drift_ > kMaxDrift; }
  /// Adds an upper bound of a displacement of the particles to their drift [cells].
  void add_drift(double cells) { drift_ += cells; }
  /// Returns true if the lists that depend on the set of blocks must be rebuilt.
  bool blocks_changed() const { return blocks_changed_; }
  /// Records that all lists that depend on the set of blocks are up to date.
  void clear_blocks_changed() { blocks_changed_ = false; }

  /// Visits all particles, blocks_changed() and the drift.
  void visit(Archive& a);

 private:
  /// Logs a warning when the number of particles first exceeds the budget.
  void check_budget(std::size_t particles);

  /// Particles on the device.
  ParticleStore store_;
  /// Number of soils of the scene.
  std::size_t soils_;
  /// Number of particles above which a warning is logged.
  int budget_;
  /// All particles, after the device had no memory for them; empty otherwise.
  std::vector<Particle> unplaced_;
  /// True if the number of particles exceeds the budget and the warning has been logged.
  bool over_budget_ = false;
  /// True if lists that depend on the set of blocks must be rebuilt.
  bool blocks_changed_ = true;
  /// Upper bound of the displacement of any particle since the last re-bin [cells].
  double drift_ = 0;
};

}  // namespace navvy::soil
