// SPDX-License-Identifier: Apache-2.0
// Cuts the upper part of resting columns into particles that carry on as the ground did.
#pragma once

#include <cstdint>
#include <vector>

#include "heightfield/layered_ground.h"
#include "soil/particles/particle.h"
#include "soil/particles/plan_grid.h"
#include "soil/particles/soil_table.h"

namespace navvy::soil {

/// Turns columns into particles, mass-exact per soil.
///
/// The soil above the cut is divided, soil by soil, into equal layers of about half a cell and each
/// layer into 2 x 2 particles; masses are differences of rounded cumulative integers. Particles are
/// at rest under their own weight and that of what lies on them, so untouched woken ground stays
/// where it is [docs/exchange.md, wake].
class Activator {
 public:
  /// `gravity` [m/s2]. Elastic constants of the soils are worked out once, here; the ground must
  /// outlive it. @throws InputError when a particle of these soils would not fit its integer mass.
  Activator(heightfield::Ground& ground, PlanGrid grid, double gravity);

  /// Appends the particles of column (ix, iy) above W height `z_bottom` [m], from the lowest up,
  /// and takes them off the column. `load` is the mass resting on the column [kg]. Nothing happens
  /// when the column is not higher. z_bottom below the datum wakes the whole column. Ids and
  /// velocities are left at zero for the solver. Costs the layers of the column and the particles
  /// it gives.
  void wake(int ix, int iy, double z_bottom, double load, std::vector<Particle>& born);

  /// At least the number of particles that waking the top `thickness` [m] of a column of few soils
  /// can give. For the budget, before anything wakes.
  int particle_bound(double thickness) const;

 private:
  struct Slice {  // a layer of particles to be
    std::uint16_t soil;
    std::int64_t mass;
    double bottom, thickness;  // [m] above the cut
    float specific_volume, shear;
  };
  // Layers [first, last) of `taken_`, all of one soil, into `slices_`.
  void slice(std::size_t first, std::size_t last, double bottom);
  // What a resting particle of the slice bears, so that it does not move when it wakes.
  void stress(const Slice& slice, double weight, Particle& particle) const;

  heightfield::Ground& ground_;
  PlanGrid grid_;
  double gravity_, cell_;
  std::vector<LawConstants> law_;
  std::vector<heightfield::SoilLayer> taken_;  // scratch
  std::vector<Slice> slices_;                  // scratch
};

}  // namespace navvy::soil
