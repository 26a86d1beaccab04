// SPDX-License-Identifier: Apache-2.0
// Faults that stop a run: motions that no soil step can carry, and values that are not finite.
#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "soil/solver_state.h"

namespace navvy::soil {
namespace {

/// Tools faster than waves in the soil drive a shock, which the law does not describe; machines are
/// far slower. In very soft soil waves are slower than machines, which may still move in the air
/// [m/s].
constexpr double kLeastTopSpeed = 10;
/// Largest depth of a moving tool in the rock [cells]. Contact begins one cell above the rock, and
/// no soil in it pushes back.
constexpr double kDeepestInRock = 1;
/// Slower tools stand [m/s].
constexpr double kMoving = 1e-3;

std::string text_of(const Vec3& p) {
  return "(" + std::to_string(p.x()) + ", " + std::to_string(p.y()) + ", " + std::to_string(p.z()) +
         ")";
}

}  // namespace

std::string Solver::State::here() const {
  return "soil step " + std::to_string(stats.steps) + ", t = " + std::to_string(time) + " s: ";
}

void Solver::State::check_motion(const ToolMotion& motion) const {
  const scene::Shell& shell = contact.geometry(motion.tool).shell();
  const std::string name = "tool '" + shell.name + "' ";
  const double sum = motion.X_WT.matrix().sum() + motion.v_WT.sum() + motion.w_WT.sum() +
                     motion.inverse_mass.sum();
  if (!std::isfinite(sum))
    throw SimulationError(here() + name + "has a pose, velocity or mass that is not finite");
  const double speed = tool_speed(motion), most = std::max(fastest_sound, kLeastTopSpeed);
  if (speed > most)
    throw SimulationError(here() + name + "moves at " + std::to_string(speed) +
                          " m/s, faster than waves in the soil (" + std::to_string(most) +
                          " m/s): its force would not be right; slow it down");
  for (const Vec3& v : shell.vertices) {
    const Vec3 p = motion.X_WT * v;
    const double depth = ground.datum() - p.z();
    if (depth <= kDeepestInRock * frame.cell) continue;
    const Vec2i column = ground.column_at(p.x(), p.y());
    if (!ground.contains(column.x(), column.y())) continue;
    if ((motion.v_WT + motion.w_WT.cross(motion.X_WT.linear() * v)).norm() < kMoving) continue;
    throw SimulationError(here() + name + "is pressed " + std::to_string(depth) +
                          " m into the rock at " + text_of(p) +
                          " m, where nothing pushes back; make <depth_m> larger or dig less deep");
  }
}

void Solver::State::fail(double speed) const {
  std::string cause = "a particle moves " +
                      std::to_string(speed * world.solver.max_step / frame.cell) +
                      " cells in one step (" + std::to_string(speed) + " m/s)";
  for (const Particle& p : particles.store().records()) {
    double sum = 0, fastest = 0;
    for (const float v : p.v) fastest = std::max(fastest, static_cast<double>(std::abs(v)));
    for (const float v : p.x) sum += v;
    for (const float v : p.v) sum += v;
    for (const float v : p.c) sum += v;
    for (const float v : p.s) sum += v;
    sum += static_cast<double>(p.j) + p.j0 + p.shear;
    if (std::isfinite(sum) && (!std::isfinite(speed) || fastest < 0.999 * speed)) continue;
    cause += std::string("; particle ") + std::to_string(p.id) +
             (std::isfinite(sum) ? " is the fastest" : " has a value that is not finite") +
             ", block (" + std::to_string(p.block[0]) + ", " + std::to_string(p.block[1]) + ", " +
             std::to_string(p.block[2]) + "), offset " + text_of(Vec3(p.x[0], p.x[1], p.x[2])) +
             " cells, volume ratio " + std::to_string(p.j);
    break;
  }
  throw SimulationError(here() + cause);
}

}  // namespace navvy::soil
