// SPDX-License-Identifier: Apache-2.0
// The particles of a solver: the store on the device, and the drift since its last re-bin.
#pragma once

#include <cstdint>
#include <vector>

#include "soil/particles/particle_store.h"

namespace navvy {
class Archive;
}

namespace navvy::soil {

/// Drift that calls for a re-bin before the next transfer [cells]. The margin of a tile is one
/// cell, minus one push.
inline constexpr double kMaxDrift = 0.75;

/// Returns the particle with the block that contains its cell, instead of the block it is stored
/// in.
Particle in_cell_block(Particle p);

/// Particles on the device. If the device runs out of memory the run is over; the particles then
/// stay on the host, so that ledger and snapshot remain complete.
///
/// `assign`, `rebin` and a load change the set of blocks. `blocks_changed` then stays true until
/// the solver has made its lists anew.
class SoilParticles {
 public:
  /// Creates an empty set. `site`, `soils`: see ParticleStore. `budget`: number of particles above
  /// which a warning is logged.
  SoilParticles(device::Device& device, const std::array<std::int32_t, 4>& site,
                const std::vector<SoilRow>& soils, int budget);

  /// Returns the particles on the device.
  ParticleStore& store() { return store_; }
  const ParticleStore& store() const { return store_; }
  /// Returns the number of particles on the device.
  int count() const { return store_.count(); }

  /// Returns all particles in stored order.
  std::vector<Particle> records() const;
  /// Returns the particles of the device, each with the block that its cell lies in.
  std::vector<Particle> by_cell() const;
  /// Returns the particles in a box of G [cells], and some around it.
  std::vector<PointMass> masses_near(const Vec3& low, const Vec3& high) const;
  /// Counts the mass of each soil [kMassQuantum].
  std::vector<std::int64_t> masses() const;

  /// Replaces all particles.
  /// @throws device::DeviceError when the device has no memory for them.
  void assign(const std::vector<Particle>& particles);
  /// Sorts the particles into new blocks; returns those that left the site.
  std::vector<Particle> rebin();
  /// Returns true when particles may leave the margin of their tiles in the next transfer.
  bool rebin_due() const { return drift_ > kMaxDrift; }
  /// Adds a displacement [cells] that particles may have made.
  void add_drift(double cells) { drift_ += cells; }
  /// Returns true while lists of blocks must be made anew.
  bool blocks_changed() const { return blocks_changed_; }
  /// Notes that all lists are up to date.
  void clear_blocks_changed() { blocks_changed_ = false; }

  /// Visits the particles, and whether the next step makes lists anew.
  void visit(Archive& a);

 private:
  ParticleStore store_;
  std::size_t soils_;
  int budget_;
  /// All particles, once the device has no memory for them.
  std::vector<Particle> unplaced_;
  /// The warning has been logged.
  bool over_budget_ = false;
  bool blocks_changed_ = true;
  /// Cells that particles may have moved since the last re-bin.
  double drift_ = 0;
};

}  // namespace navvy::soil
