// SPDX-License-Identifier: Apache-2.0
// A small site for the exchange tests: flat ground of chosen soils, and mass balances of columns
// and particles.
#pragma once

#include <cmath>
#include <functional>
#include <vector>

#include "heightfield/layered_ground.h"
#include "scene/scene.h"
#include "soil/exchange/exchange.h"

namespace navvy::soil {

inline constexpr double kCell = 0.1;    // [m]
inline constexpr double kCheck = 0.04;  // simulated time between checks [s]

inline scene::Soil sand() {
  scene::Soil soil;
  soil.name = "sand";
  soil.bank_density = 1600;
  soil.swell = 1.13;
  soil.friction_angle = radians(35);
  soil.cohesion = soil.residual_cohesion = 0;
  return soil;
}

inline scene::Soil loam() {
  scene::Soil soil;
  soil.name = "loam";
  soil.bank_density = 1540;
  soil.swell = 1.23;
  soil.friction_angle = radians(30);
  soil.cohesion = 5000;
  soil.residual_cohesion = 1000;
  return soil;
}

inline heightfield::Ground make_ground(
    const scene::Scene& world, int nx, int ny, std::vector<scene::GroundLayer> layers,
    heightfield::SurfaceSource surface = [](int, int) { return 0.0; }) {
  heightfield::Ground::Setup setup;
  setup.nx = nx;
  setup.ny = ny;
  setup.cell = world.solver.cell;
  // Not at zero, so that a missing origin shows.
  setup.origin = Vec2(-3, 2);
  setup.datum = -5;
  setup.soils = world.soils;
  setup.layers = std::move(layers);
  setup.surface = std::move(surface);
  return heightfield::Ground(std::move(setup));
}

/// Ground, exchange and the particles between them, without a solver: particles do not move.
struct Site {
  explicit Site(
      std::vector<scene::Soil> soils, int nx = 48, int ny = 40,
      std::vector<scene::GroundLayer> layers = {},
      heightfield::SurfaceSource surface = [](int, int) { return 0.0; })
      : world(make_world(std::move(soils))),
        ground(make_ground(
            world, nx, ny,
            layers.empty() ? std::vector<scene::GroundLayer>{{world.soils[0].name, 9}} : layers,
            std::move(surface))),
        exchange(world, ground) {}

  static scene::Scene make_world(std::vector<scene::Soil> soils) {
    scene::Scene world;
    world.soils = std::move(soils);
    world.solver.cell = kCell;
    return world;
  }

  /// Runs one check and applies its result to the particles.
  Exchange::Result check(const std::vector<ToolRegion>& tools = {}) {
    Exchange::Result result = exchange.check(particles, tools, time, step);
    time += step;
    std::vector<Particle> stay;
    for (std::size_t i = 0; i < particles.size(); ++i)
      if (result.removed[i] == 0) stay.push_back(particles[i]);
    for (Particle& p : result.born) {
      p.id = next_id++;
      stay.push_back(p);
    }
    particles = stay;
    return result;
  }
  /// Runs checks for `seconds`; returns the sums of their counts.
  Exchange::Result checks(double seconds, const std::vector<ToolRegion>& tools = {}) {
    Exchange::Result sum;
    for (int n = static_cast<int>(std::lround(seconds / step)); n > 0; --n) {
      const Exchange::Result one = check(tools);
      sum.activated_columns += one.activated_columns;
      sum.deposited_blocks += one.deposited_blocks;
      sum.slumped_columns += one.slumped_columns;
    }
    return sum;
  }
  void add(std::vector<Particle> more) {
    for (Particle& p : more) {
      p.id = next_id++;
      particles.push_back(p);
      inserted.resize(world.soils.size());
      inserted[p.soil] += p.mass;
    }
  }
  /// Activates a rectangle and adds its particles.
  void activate(const heightfield::CellRect& rect, double z_bottom) {
    for (Particle& p : exchange.activate(rect, z_bottom, particles)) {
      p.id = next_id++;
      particles.push_back(p);
    }
  }
  /// Returns columns and particles minus their start, per soil; all zero when the mass is balanced.
  std::vector<std::int64_t> mass_errors() const {
    std::vector<std::int64_t> sum = ground.mass_change();
    for (std::size_t s = 0; s < inserted.size(); ++s) sum[s] -= inserted[s];
    for (const Particle& p : particles) sum[p.soil] += p.mass;
    return sum;
  }
  std::vector<std::int64_t> closed() const {
    return std::vector<std::int64_t>(world.soils.size(), 0);
  }
  std::vector<float> heights() const {
    std::vector<float> out;
    ground.copy_heights({0, 0, ground.nx(), ground.ny()}, out);
    return out;
  }

  scene::Scene world;
  heightfield::Ground ground;
  Exchange exchange;
  std::vector<Particle> particles;
  std::vector<std::int64_t> inserted;
  /// Simulated time, and time between checks [s].
  double time = 0, step = kCheck;
  std::uint32_t next_id = 1;
};

/// Returns a particle at rest at (x, y, z) in cells of the grid frame.
inline Particle particle_at(const Site& site, double x, double y, double z, double volume_cells,
                            float j0, std::uint16_t soil = 0) {
  Particle p;
  const double at[3] = {x, y, z};
  for (int a = 0; a < 3; ++a) {
    p.block[a] = static_cast<std::int32_t>(std::floor(at[a] / kBlockCells));
    p.x[a] = static_cast<float>(at[a] - kBlockCells * p.block[a]);
  }
  p.j = p.j0 = j0;
  p.soil = soil;
  p.shear = 2;
  p.mass = static_cast<std::int32_t>(
      mass_units(volume_cells * kCell * kCell * kCell * site.world.soils[soil].bank_density /
                 static_cast<double>(j0)));
  return p;
}

/// Returns soil where `inside(x, y, z)` (cells), 8 particles per cell on a lattice, jittered.
inline std::vector<Particle> fill(const Site& site, const Eigen::Vector3i& low,
                                  const Eigen::Vector3i& high, float j0,
                                  const std::function<bool(double, double, double)>& inside,
                                  double jitter = 0, std::uint16_t soil = 0) {
  std::vector<Particle> out;
  std::uint64_t state = 7;
  const auto noise = [&] {
    state = state * 6364136223846793005ULL + 1442695040888963407ULL;
    return (static_cast<double>(state >> 40) / (1 << 24) - 0.5) * jitter;
  };
  for (int z = 2 * low.z(); z < 2 * high.z(); ++z)
    for (int y = 2 * low.y(); y < 2 * high.y(); ++y)
      for (int x = 2 * low.x(); x < 2 * high.x(); ++x) {
        const double cx = 0.5 * x + 0.25, cy = 0.5 * y + 0.25, cz = 0.5 * z + 0.25;
        if (inside(cx, cy, cz))
          out.push_back(
              particle_at(site, cx + noise(), cy + noise(), cz + noise(), 0.125, j0, soil));
      }
  return out;
}

}  // namespace navvy::soil
