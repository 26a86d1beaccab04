// SPDX-License-Identifier: Apache-2.0
// Turns the upper part of resting columns into particles in the same mechanical state.
#pragma once

#include <cstdint>
#include <vector>

#include "heightfield/layered_ground.h"
#include "soil/particles/particle.h"
#include "soil/particles/plan_grid.h"
#include "soil/particles/soil_table.h"

namespace navvy::soil {

/// Turns columns into particles. The mass of each soil is preserved exactly.
///
/// The soil of a column above a cut height is divided, soil by soil, into equal slices about half a
/// cell thick, and each slice into 2 x 2 particles. Particle masses are differences of rounded
/// cumulative integers, so that their sum is exact. The particles are in equilibrium under their
/// own weight and the load on them, so active ground that is not disturbed stays at rest
/// [docs/exchange.md, activation].
class Activator {
 public:
  /// Computes the elastic constants of the soils. `ground` must outlive this object; `grid`: offset
  /// of the particle blocks relative to the columns; `gravity`: downward acceleration of gravity
  /// [m/s2].
  /// @throws InputError when a particle of one of the soils would exceed the range of its integer
  /// mass.
  Activator(heightfield::Ground& ground, PlanGrid grid, double gravity);

  /// Removes the soil of column (ix, iy) above height `z_bottom` [m in W] from the column and
  /// appends its particles to `born`, from bottom to top. `load`: mass that rests on the column
  /// [kg].
  ///
  /// Does nothing if the column does not reach above `z_bottom`. A `z_bottom` below the datum takes
  /// the whole column. IDs and velocities of the particles are zero; the solver assigns IDs. Cost
  /// is linear in the number of layers and particles.
  void activate(int ix, int iy, double z_bottom, double load, std::vector<Particle>& born);

  /// Returns an upper bound of the number of particles that the top `thickness` [m] of a column
  /// becomes, for the particle budget. It holds for columns of few soils; many thin layers may give
  /// a few more.
  int particle_bound(double thickness) const;

 private:
  /// A horizontal slice of a column that becomes four particles.
  struct Slice {
    /// Index of the soil.
    std::uint16_t soil;
    /// Mass [kMassQuantum].
    std::int64_t mass;
    /// `bottom`: height of the slice's bottom above the lowest soil that is activated [m].
    /// `thickness`: thickness of the slice [m].
    double bottom, thickness;
    /// `specific_volume`: volume / bank volume of the soil. `shear`: plastic shear strain of the
    /// soil.
    float specific_volume, shear;
  };
  /// Divides the layers [first, last) of `taken_`, which must be of one soil, into slices and
  /// appends them to `slices_`. `bottom`: height of the bottom of layer `first` above the lowest
  /// soil that is activated [m].
  void slice(std::size_t first, std::size_t last, double bottom);
  /// Sets stress and volume ratio of a particle of the slice so that it is in equilibrium under the
  /// vertical stress `weight` [Pa].
  void stress(const Slice& slice, double weight, Particle& particle) const;

  /// Columns of the site.
  heightfield::Ground& ground_;
  /// Offset of the particle blocks relative to the columns.
  PlanGrid grid_;
  /// `gravity_`: downward acceleration of gravity [m/s2]. `cell_`: edge of a cell [m].
  double gravity_, cell_;
  /// Constants of the soil law, by soil index.
  std::vector<LawConstants> law_;
  /// Scratch memory: layers taken from the column.
  std::vector<heightfield::SoilLayer> taken_;
  /// Scratch memory: slices of those layers.
  std::vector<Slice> slices_;
};

}  // namespace navvy::soil
