// SPDX-License-Identifier: Apache-2.0
#include "sim/particle_clipper.h"

#include <algorithm>
#include <cmath>

#include "geometry/pieces.h"

namespace navvy::sim {
namespace {

/// In the corner of two plates a particle is pushed off one, then off the other.
constexpr int kPushes = 4;

/// Returns `p` pushed off the faces of one shell. Where they leave less space than `gap`, it ends
/// as far away as possible on its own side.
Vec3 pushed(const soil::ShellGeometry& geometry, Vec3 p, double gap, int& closest) {
  const double half = geometry.shell().half_thickness;
  soil::ShellGeometry::Nearest at = geometry.nearest(p, closest);
  const double side = at.distance < 0 ? -1 : 1;
  Vec3 best = p;
  double farthest = std::abs(at.distance);
  for (int i = 0; i < kPushes && std::abs(at.distance) - half < gap; ++i) {
    Vec3 away = p - at.place;
    // On the plate's middle surface the normal is the only direction.
    if (!(away.norm() > 1e-9)) away = side * at.normal;
    p = at.place + (half + gap) * away.normalized();
    at = geometry.nearest(p, closest);
    if (at.distance * side < 0) break;
    if (std::abs(at.distance) > farthest) best = p, farthest = std::abs(at.distance);
  }
  return best;
}

}  // namespace

ParticleClipper::ParticleClipper(const World& world) : world_(world) {
  for (std::size_t m = 0; m < world.description().machines.size(); ++m) {
    const scene::Machine& machine = world.description().machines[m].machine;
    for (const scene::Shell& shell : machine.shells)
      tools_.push_back(
          {static_cast<int>(m), machine.link_index(shell.link), {shell, world.ground().cell()}});
  }
}

// Tests each particle against each shell; most fail the first, cheap test.
void ParticleClipper::keep_off(scene::FrameParticles& particles, double gap, double reach) const {
  const std::size_t count = particles.position.size() / 3;
  particles.clearance.assign(count, static_cast<float>(reach));
  particles.away.assign(3 * count, 0);
  for (const Tool& tool : tools_) {
    const Pose X_WT = world_.machines().at(tool.machine).link(tool.link).pose(),
               X_TW = X_WT.inverse();
    // Most particles are far from any tool: a sphere around the shell's box excludes them.
    const geometry::Box box = geometry::bounds(tool.geometry.shell());
    const Vec3 centre = X_WT * (0.5 * (box.low + box.high));
    const double radius = 0.5 * (box.high - box.low).norm() + reach;
    const double half = tool.geometry.shell().half_thickness;
    // Triangle of the last particle: neighbours in memory are neighbours in space.
    int closest = 0;
    for (std::size_t i = 0; i < count; ++i) {
      float* place = &particles.position[3 * i];
      const Vec3 p_W = particles.origin + Eigen::Map<const Eigen::Vector3f>(place).cast<double>();
      if ((p_W - centre).squaredNorm() > radius * radius) continue;
      const Vec3 p_T = X_TW * p_W;
      // The box itself excludes soil below an empty bucket that is inside the sphere.
      if ((p_T.array() < box.low.array() - reach).any() ||
          (p_T.array() > box.high.array() + reach).any())
        continue;
      const Vec3 moved = pushed(tool.geometry, p_T, gap, closest);
      const soil::ShellGeometry::Nearest at = tool.geometry.nearest(moved, closest);
      const auto clearance = static_cast<float>(std::max(0.0, std::abs(at.distance) - half));
      if (clearance < particles.clearance[i]) {
        particles.clearance[i] = clearance;
        const Vec3 away = X_WT.linear() * (moved - at.place);
        if (away.norm() > 1e-9)
          Eigen::Map<Eigen::Vector3f>{&particles.away[3 * i]} = away.normalized().cast<float>();
      }
      if (moved != p_T)
        Eigen::Map<Eigen::Vector3f>{place} = (X_WT * moved - particles.origin).cast<float>();
    }
  }
}

}  // namespace navvy::sim
