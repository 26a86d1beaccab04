// SPDX-License-Identifier: Apache-2.0
// Turns the upper part of resting columns into particles in the same state.
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
/// The soil above the cut is divided, soil by soil, into equal layers of about half a cell, and
/// each layer into 2 x 2 particles. Masses are differences of rounded cumulative integers.
/// Particles are in equilibrium under their own weight and the load on them, so undisturbed active
/// ground stays where it is [docs/exchange.md, activation].
class Activator {
 public:
  /// Prepares the elastic constants of the soils. The ground must outlive it. `gravity` [m/s2].
  /// @throws InputError when a particle of these soils would not fit its integer mass.
  Activator(heightfield::Ground& ground, PlanGrid grid, double gravity);

  /// Appends the particles of column (ix, iy) above the height `z_bottom` [m in W], from the lowest
  /// up, and removes them from the column. `load` is the mass resting on the column [kg]. Does
  /// nothing when the column is lower; a z_bottom below the datum takes the whole column. Ids and
  /// velocities are left at zero for the solver. Cost is linear in the layers of the column and the
  /// particles.
  void activate(int ix, int iy, double z_bottom, double load, std::vector<Particle>& born);

  /// Returns an upper bound of the particles from the top `thickness` [m] of a column of few soils,
  /// for the budget.
  int particle_bound(double thickness) const;

 private:
  // A layer of future particles.
  struct Slice {
    std::uint16_t soil;
    std::int64_t mass;
    // [m] above the cut.
    double bottom, thickness;
    float specific_volume, shear;
  };
  // Divides layers [first, last) of `taken_`, all of one soil, into `slices_`.
  void slice(std::size_t first, std::size_t last, double bottom);
  // Sets the stress of a resting particle of the slice, so that it stays in equilibrium.
  void stress(const Slice& slice, double weight, Particle& particle) const;

  heightfield::Ground& ground_;
  PlanGrid grid_;
  double gravity_, cell_;
  std::vector<LawConstants> law_;
  // Scratch.
  std::vector<heightfield::SoilLayer> taken_;
  // Scratch.
  std::vector<Slice> slices_;
};

}  // namespace navvy::soil
