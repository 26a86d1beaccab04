// SPDX-License-Identifier: Apache-2.0
// Small set-ups shared by the tests of the soil: a soil, a flat site with a pit, particles that fill a box.
#pragma once

#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "core/math.h"
#include "device/device.h"
#include "heightfield/ground.h"
#include "scene/world.h"
#include "soil/soil_table.h"
#include "soil/solver.h"

namespace navvy::soil::rig {

/// Prints one row of the validation table.
inline void report(const std::string& what, double measured, const std::string& expected, const std::string& source) {
  std::printf("[ VALUE    ] %s: measured %.5g, expected %s (%s)\n", what.c_str(), measured, expected.c_str(),
              source.c_str());
}

inline scene::Soil sand(double friction_degrees = 33) {
  scene::Soil soil;
  soil.name = "sand";
  soil.bank_density = 1600;
  soil.swell = 1;
  soil.friction_angle = radians(friction_degrees);
  soil.cohesion = soil.residual_cohesion = 0;
  soil.tool_friction_angle = radians(20);
  return soil;
}

/// A box in W [m].
struct Box {
  Vec3 low, high;
  bool contains(const Vec3& p) const { return (p.array() >= low.array()).all() && (p.array() < high.array()).all(); }
};

/// One flat site (surface at z = 0, bedrock 4 m below) with an optional pit that particles will fill.
class Rig {
 public:
  explicit Rig(const std::vector<scene::Soil>& soils, const Box& pit = {Vec3::Zero(), Vec3::Zero()}, double cell = 0.1,
               int cells = 200, const Vec2& origin = Vec2::Zero())
      : ground_(setup(soils, pit, cell, cells, origin)) {
    world_.soils = soils;
    world_.solver.cell = cell;
    world_.solver.exchange = false;
    solver_ = std::make_unique<Solver>(device(), world_, ground_);
  }

  /// One device for all tests of a program: kernels build once.
  static device::Device& device() {
    static device::Device shared;
    return shared;
  }
  Solver& solver() { return *solver_; }
  heightfield::Ground& ground() { return ground_; }
  const scene::World& world() const { return world_; }
  double cell() const { return world_.solver.cell; }
  double datum() const { return ground_.datum(); }

  /// A resting particle of bank density at p_W that stands for `volume` [m3].
  Particle particle(const Vec3& p_W, double volume, int soil = 0) const {
    Particle p;
    const Vec3 grid = (p_W - Vec3(ground_.origin().x(), ground_.origin().y(), ground_.datum())) / cell();
    for (int a = 0; a < 3; ++a) {
      p.block[a] = static_cast<int>(std::floor(grid[a] / kBlockCells));
      p.x[a] = static_cast<float>(grid[a] - kBlockCells * p.block[a]);
    }
    p.soil = static_cast<std::uint16_t>(soil);
    p.mass = static_cast<std::int32_t>(mass_units(world_.soils[static_cast<std::size_t>(soil)].bank_density * volume));
    return p;
  }
  /// Particles on a lattice of half a cell; `depth_stress`: with the stress of resting ground whose top is the box's.
  std::vector<Particle> fill(const Box& box, bool depth_stress = false, int soil = 0) const {
    std::vector<Particle> out;
    const double h = cell() / 2;
    const Vec3 size = (box.high - box.low) / h;
    const int nx = static_cast<int>(std::lround(size.x())), ny = static_cast<int>(std::lround(size.y())),
              nz = static_cast<int>(std::lround(size.z()));
    for (int k = 0; k < nz; ++k)
      for (int j = 0; j < ny; ++j)
        for (int i = 0; i < nx; ++i) {
          const Vec3 p_W = box.low + h * Vec3(i + 0.5, j + 0.5, k + 0.5);
          out.push_back(particle(p_W, h * h * h, soil));
          if (depth_stress) rest(out.back(), box.high.z() - p_W.z());
        }
    return out;
  }
  /// Gives a particle the stress of level ground at rest: sigma_x = nu / (1 - nu) sigma_z.
  void rest(Particle& p, double depth) const {
    const scene::Soil& soil = world_.soils[p.soil];
    const double k0 = soil.poisson / (1 - soil.poisson), sz = -soil.bank_density * kGravity * depth;
    const double pressure = -(1 + 2 * k0) * sz / 3;
    p.j = static_cast<float>(p.j0 * (1 - pressure / law_constants(soil, cell()).bulk));
    p.s[0] = p.s[1] = static_cast<float>(k0 * sz + pressure);
    p.s[2] = static_cast<float>(sz + pressure);
  }
  Vec3 position(const Particle& p) const {
    Vec3 grid;
    for (int a = 0; a < 3; ++a) grid[a] = kBlockCells * p.block[a] + static_cast<double>(p.x[a]);
    return grid * cell() + Vec3(ground_.origin().x(), ground_.origin().y(), ground_.datum());
  }
  /// Steps without tools for `seconds` at the step limit; returns the step.
  double run(double seconds) {
    const double limit = solver().step_limit(0);
    const int steps = static_cast<int>(std::ceil(seconds / limit));
    for (int i = 0; i < steps; ++i) solver().step(seconds / steps, {}, {});
    return seconds / steps;
  }
  std::uint64_t digest() {
    StateHash hash;
    solver().hash(hash);
    return hash.digest();
  }

 private:
  static heightfield::Ground::Setup setup(const std::vector<scene::Soil>& soils, const Box& pit, double cell, int cells,
                                          const Vec2& origin) {
    heightfield::Ground::Setup out;
    out.nx = out.ny = cells;
    out.cell = cell;
    out.origin = origin;
    out.datum = -4;
    out.soils = soils;
    out.layers = {{soils[0].name, 4}};
    out.surface = [=](int ix, int iy) {
      const double x = origin.x() + (ix + 0.5) * cell, y = origin.y() + (iy + 0.5) * cell;
      const bool inside = x > pit.low.x() && x < pit.high.x() && y > pit.low.y() && y < pit.high.y();
      return inside ? pit.low.z() : 0.0;
    };
    return out;
  }
  scene::World world_;
  heightfield::Ground ground_;
  std::unique_ptr<Solver> solver_;
};

/// A box open at the top, floor at z = 0 of its frame, inside = front.
inline scene::Shell open_box(double length, double width, double height, double half_thickness = 0.015) {
  scene::Shell s;
  s.name = "box";
  s.half_thickness = half_thickness;
  const double x = length / 2, y = width / 2, h = height;
  s.vertices = {{-x, -y, 0}, {x, -y, 0}, {x, y, 0}, {-x, y, 0}, {-x, -y, h}, {x, -y, h}, {x, y, h}, {-x, y, h}};
  s.triangles = {{0, 1, 2}, {0, 2, 3}, {0, 4, 5}, {0, 5, 1}, {1, 5, 6},
                 {1, 6, 2}, {2, 6, 7}, {2, 7, 3}, {3, 7, 4}, {3, 4, 0}};
  return s;
}

/// An upright plate of `width` along y, from z = 0 up; its front looks along +x.
inline scene::Shell blade(double width, double height) {
  scene::Shell s;
  s.name = "blade";
  const double y = width / 2;
  s.vertices = {{0, -y, 0}, {0, y, 0}, {0, y, height}, {0, -y, height}};
  s.triangles = {{0, 1, 2}, {0, 2, 3}};
  return s;
}

}  // namespace navvy::soil::rig
