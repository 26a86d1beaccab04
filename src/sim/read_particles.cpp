// SPDX-License-Identifier: Apache-2.0
#include "sim/read_particles.h"

#include <algorithm>

#include "sim/world_parts.h"
#include "soil/particles/soil_table.h"

namespace navvy::sim {
namespace {

/// Returns the total stress, in the order and with the sign of Particle::s [Pa].
void put_stress(const soil::Particle& p, double bulk, float* to) {
  const double pressure =
      bulk * std::max(0.0, 1 - static_cast<double>(p.j) / static_cast<double>(p.j0));
  for (int k = 0; k < 6; ++k)
    to[k] = static_cast<float>(static_cast<double>(p.s[k]) - (k < 3 ? pressure : 0));
}

}  // namespace

scene::ParticleTable read_particles(const World& world) {
  const soil::Solver& solver = parts(world).soil;
  const double cell = world.ground().cell();
  scene::ParticleTable out;
  out.time = world.time();
  out.steps = world.steps();
  std::vector<double> bulk;
  for (const scene::Soil& soil : world.description().soils) {
    out.soils.push_back({soil.name, soil.bank_density});
    bulk.push_back(soil::law_constants(soil, cell).bulk);
  }
  const std::vector<soil::Particle> all = solver.particles();
  out.resize(all.size());
  for (std::size_t i = 0; i < all.size(); ++i) {
    const soil::Particle& p = all[i];
    for (std::size_t a = 0; a < 3; ++a) {
      // Cells are counted from the corner of a block, so they are exact in a double.
      const double in_cells = p.block[a] * soil::kBlockCells + static_cast<double>(p.x[a]);
      out.position[3 * i + a] = solver.grid_origin()[static_cast<int>(a)] + in_cells * cell;
      out.velocity[3 * i + a] = p.v[a];
    }
    std::copy_n(p.c, 9, out.velocity_gradient.begin() + static_cast<std::ptrdiff_t>(9 * i));
    put_stress(p, bulk[p.soil], out.stress.data() + 6 * i);
    out.id[i] = p.id;
    out.mass[i] = kilograms(p.mass);
    out.soil[i] = p.soil;
    out.volume_ratio[i] = p.j;
    out.density[i] = static_cast<float>(out.soils[p.soil].bank_density / static_cast<double>(p.j));
    out.density_state[i] = p.j0;
    out.plastic_shear[i] = p.shear;
  }
  return out;
}

}  // namespace navvy::sim
