// SPDX-License-Identifier: Apache-2.0
#include "sim/start_placing.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "core/error.h"
#include "coupling/machine_placing.h"

namespace navvy::sim {

std::vector<Pose> starting_poses(const scene::Scene& scene, const heightfield::Ground& ground) {
  std::vector<Pose> X_WB;
  X_WB.reserve(scene.machines.size());
  for (const scene::MachineInWorld& placed : scene.machines)
    X_WB.push_back(coupling::base_pose(placed.machine, coupling::place(placed, ground)));
  return X_WB;
}

// Rounds to the nearest column border.
heightfield::CellRect active_columns(const scene::ActiveSoil& active,
                                     const heightfield::Ground& ground) {
  const auto cell = [&](double metres, double from, int cells) {
    return static_cast<int>(
        std::clamp(std::round((metres - from) / ground.cell()), 0.0, static_cast<double>(cells)));
  };
  const Vec2 from = ground.origin();
  return {cell(active.min.x(), from.x(), ground.nx()), cell(active.min.y(), from.y(), ground.ny()),
          cell(active.max.x(), from.x(), ground.nx()), cell(active.max.y(), from.y(), ground.ny())};
}

// Counts from column heights alone and stops as soon as the budget is exceeded.
void check_active(const scene::Scene& scene, const heightfield::Ground& ground) {
  // Eight particles per cell, as activated soil has [docs/exchange.md]. Thin columns give fewer, so
  // rounding refuses no scene.
  const double each = std::pow(ground.cell() / 2, 3);
  const double most = scene.solver.max_particles;
  double particles = 0, columns = 0;
  for (std::size_t i = 0; i < scene.ground.active.size(); ++i) {
    const scene::ActiveSoil& active = scene.ground.active[i];
    const heightfield::CellRect rect = active_columns(active, ground);
    for (int iy = rect.y0; iy < rect.y1; ++iy)
      for (int ix = rect.x0; ix < rect.x1; ++ix) {
        const double thickness =
            std::max(0.0, ground.height(ix, iy) - std::max(active.bottom, ground.datum()));
        particles += thickness * ground.cell() * ground.cell() / each;
        if (particles <= most && ++columns <= most) continue;
        throw InputError(Fault{Fault::Severity::kError, scene.file, 0,
                               "world/navvy:ground/active[" + std::to_string(i + 1) + "]",
                               std::to_string(rect.area()) + " columns",
                               "holds more soil than the " +
                                   std::to_string(scene.solver.max_particles) +
                                   " particles of max_particles",
                               "make the box smaller, or max_particles larger (216 bytes each)"});
      }
  }
}

}  // namespace navvy::sim
