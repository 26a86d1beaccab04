// SPDX-License-Identifier: Apache-2.0
// The particles of a solver: the store on the device, and what is counted since its last re-bin.
#pragma once

#include <cstdint>
#include <vector>

#include "soil/particles/particle_store.h"

namespace navvy {
class Archive;
}

namespace navvy::soil {

/// Drift that calls for a re-bin before the next transfer [cells]: one cell is the tile's margin,
/// less one push.
inline constexpr double kMaxDrift = 0.75;

/// Returns the particle with the block that its cell lies in, instead of the one it is stored by.
Particle in_cell_block(Particle p);

/// Particles on the device. Once the device could not take them the run is over, and they stay on
/// the host so that ledger and snapshot remain whole.
class SoilParticles {
 public:
  /// `site`, `soils`: see ParticleStore. `budget`: particles above which a warning is logged.
  SoilParticles(device::Device& device, const std::array<std::int32_t, 4>& site,
                const std::vector<SoilRow>& soils, int budget);

  ParticleStore& store() { return store_; }
  const ParticleStore& store() const { return store_; }
  int count() const { return store_.count(); }

  /// Returns all particles in stored order.
  std::vector<Particle> records() const;
  /// Returns the particles of the device, each with the block that its cell lies in.
  std::vector<Particle> by_cell() const;
  /// Returns the particles in a box of G [cells], and some around it.
  std::vector<PointMass> masses_near(const Vec3& low, const Vec3& high) const;
  /// Counts the mass of each soil [kMassQuantum].
  std::vector<std::int64_t> masses() const;

  /// Replaces all particles. @throws device::DeviceError when the device has no memory for them.
  void assign(const std::vector<Particle>& particles);
  /// Sorts the particles into new blocks if they drifted far; returns those that left the site.
  std::vector<Particle> rebin();
  bool rebin_due() const { return drift_ > kMaxDrift; }
  /// Adds a displacement [cells] that particles may have made.
  void add_drift(double cells) { drift_ += cells; }
  /// Returns true while lists of blocks must be made anew.
  bool blocks_changed() const { return blocks_changed_; }
  void clear_blocks_changed() { blocks_changed_ = false; }

  /// Visits the particles, and whether the next step makes lists anew.
  void visit(Archive& a);

 private:
  ParticleStore store_;
  std::size_t soils_;
  int budget_;
  std::vector<Particle> unplaced_;  ///< all of them, once the device could not take them
  bool over_budget_ = false;        ///< the warning has been logged
  bool blocks_changed_ = true;
  double drift_ = 0;  ///< cells that particles may have moved since the last re-bin
};

}  // namespace navvy::soil
