// SPDX-License-Identifier: Apache-2.0
// Loose soil in a shell at the start, as in a truck that arrives loaded.
#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "soil/solver.h"
#include "soil/solver_state.h"

namespace navvy::soil {
namespace {

/// Particles start at this distance from the plates [cells], as soil at rest on them does.
constexpr double kFromPlate = 0.5;
// Spacing of particles [cells].
constexpr double kSpacing = 0.5;

/// Returns the points of the grid frame inside the shell, level by level from below [cells].
std::vector<std::vector<Vec3>> levels_inside(const ShellGeometry& geometry, const Pose& X_WT,
                                             const Vec3& origin, double cell) {
  Vec3 low = Vec3::Constant(1e300), high = -low;
  for (const Vec3& v : geometry.shell().vertices) {
    const Vec3 grid = (X_WT * v - origin) / cell;
    low = low.cwiseMin(grid);
    high = high.cwiseMax(grid);
  }
  const Vec3 count = ((high - low) / kSpacing).array().ceil();
  const Pose X_TW = X_WT.inverse();
  std::vector<std::vector<Vec3>> levels;
  for (int k = 0; k < count.z(); ++k) {
    std::vector<Vec3> level;
    for (int j = 0; j < count.y(); ++j)
      for (int i = 0; i < count.x(); ++i) {
        const Vec3 grid = low + kSpacing * Vec3(i + 0.5, j + 0.5, k + 0.5);
        const Vec3 p_T = X_TW * (origin + cell * grid);
        if (geometry.holds(p_T) && geometry.distance(p_T) > kFromPlate * cell)
          level.push_back(grid);
      }
    levels.push_back(std::move(level));
  }
  return levels;
}

Particle at_rest(const Vec3& grid, int soil, double swell) {
  Particle p;
  for (int a = 0; a < 3; ++a) {
    p.block[a] = static_cast<int>(std::floor(grid[a] / kBlockCells));
    p.x[a] = static_cast<float>(grid[a] - kBlockCells * p.block[a]);
  }
  p.j = p.j0 = static_cast<float>(swell);
  // Dug soil is loose and remoulded.
  p.shear = 1;
  p.soil = static_cast<std::uint16_t>(soil);
  return p;
}

}  // namespace

void Solver::fill(int tool, const Pose& X_WT, int soil, double mass) {
  State& s = *state_;
  const scene::Soil& kind = s.world.soils.at(static_cast<std::size_t>(soil));
  const double each = kind.bank_density / kind.swell * std::pow(kSpacing * s.frame.cell, 3);
  auto wanted = static_cast<std::size_t>(std::max(1.0, std::round(mass / each)));
  std::vector<Particle> load;
  for (const std::vector<Vec3>& level :
       levels_inside(s.contact.geometry(tool), X_WT, s.frame.origin, s.frame.cell)) {
    // The last level is filled evenly.
    const std::size_t n = std::min(level.size(), wanted - load.size());
    for (std::size_t i = 0; i < n; ++i)
      load.push_back(at_rest(level[i * level.size() / n], soil, kind.swell));
  }
  if (load.size() < wanted)
    throw InputError(Fault{Fault::Severity::kError, "", 0, "load/mass_kg", std::to_string(mass),
                           "the bed holds at most " +
                               std::to_string(each * static_cast<double>(load.size())) +
                               " kg of loose '" + kind.name + "'",
                           "load less"});
  const std::int64_t units = mass_units(mass), count = static_cast<std::int64_t>(load.size());
  for (std::int64_t i = 0; i < count; ++i)
    load[static_cast<std::size_t>(i)].mass =
        static_cast<std::int32_t>(units / count + (i < units % count ? 1 : 0));
  insert(load);
}

}  // namespace navvy::soil
