// SPDX-License-Identifier: Apache-2.0
// Single stages of the transfer: particles in a store, no tools, the ground far below or where the
// test puts it.
#pragma once

#include <cmath>
#include <vector>

#include "core/random.h"
#include "soil/particles/transfer.h"
#include "soil/reference/reference_solver.h"
#include "soil/rig.h"

namespace navvy::soil {

inline constexpr double kStageCell = 0.1, kStageStep = 1e-3;

/// Returns `count` particles scattered over a few blocks around a corner where eight of them meet;
/// repeatable.
inline std::vector<Particle> strewn(int count) {
  Random random(7);
  std::vector<Particle> out;
  for (int i = 0; i < count; ++i) {
    Particle p;
    for (int a = 0; a < 3; ++a) {
      const double x = 40 + random.uniform(-3, 3);
      p.block[a] = static_cast<int>(std::floor(x / kBlockCells));
      p.x[a] = static_cast<float>(x - kBlockCells * p.block[a]);
      p.v[a] = static_cast<float>(random.uniform(-1, 1));
    }
    for (float& c : p.c) c = static_cast<float>(random.uniform(-3, 3));
    p.j = static_cast<float>(random.uniform(0.99, 1.02));
    p.mass = static_cast<std::int32_t>(mass_units(0.2));
    p.id = static_cast<std::uint32_t>(i);
    out.push_back(p);
  }
  return out;
}

/// The stages on one store.
struct Stages {
  explicit Stages(const std::vector<Particle>& particles, float floor = -100)
      : soils{rig::sand()},
        store(rig::Rig::device(), {0, 0, 200, 200}, soil_table(soils, kStageCell)),
        scatter(rig::Rig::device(), false),
        grid(rig::Rig::device()),
        gather(rig::Rig::device()) {
    store.assign(particles);
    const BlockTable& table = store.table();
    scatter.set_blocks(table.particle_blocks.size(),
                       store.set_near(std::vector<std::uint8_t>(table.particle_blocks.size(), 0)));
    grid.set_blocks(table, std::vector<int>(table.active.size(), -1));
    gather.set_blocks(table);
    std::vector<BlockFloor> floors(table.active.size());
    for (std::size_t b = 0; b < floors.size(); ++b)
      for (int n = 0; n < 16; ++n) {
        const float level = floor - static_cast<float>(kBlockCells * table.active[b].z);
        floors[b].held[n] = level + 0.25f;
        for (float& height : floors[b].around[n]) height = level;
      }
    grid.set_floor(floors);
    report = device::Buffer<Report>(rig::Rig::device(), table.particle_blocks.size() + 1);
    near.slot = device::Buffer<std::int32_t>(
        rig::Rig::device(), std::vector<std::int32_t>(table.active.size() + 1, -1));
    // Never read without near blocks, but arguments of the kernels.
    near.split = device::Buffer<std::int32_t>(rig::Rig::device(), 1);
    near.velocity1 = device::Buffer<float>(rig::Rig::device(), 16);
  }
  void enqueue_scatter() { scatter.enqueue(store, report, kStageStep, kStageCell, false); }
  void enqueue_grid(const Vec3& dv) { grid.enqueue(store, scatter, near, dv, false); }
  /// Queues the gather and the end of the transfer.
  void enqueue_gather() {
    gather.enqueue(store, grid.velocity(), near, scatter.used(), report, kStageStep, 0.25,
                   kStageCell);
    gather.enqueue_end(store);
  }

  std::vector<scene::Soil> soils;
  ParticleStore store;
  ParticleToGrid scatter;
  GridUpdate grid;
  GridToParticle gather;
  device::Buffer<Report> report;
  NearNodes near;
};

/// Returns momentum and mass of a list of float4s.
inline Eigen::Vector4d sum_of(const std::vector<float>& nodes, std::size_t count) {
  Eigen::Vector4d out = Eigen::Vector4d::Zero();
  for (std::size_t n = 0; n < count; ++n)
    for (int k = 0; k < 4; ++k)
      out[k] += static_cast<double>(nodes[4 * n + static_cast<std::size_t>(k)]);
  return out;
}

inline Eigen::Vector4d sum_of(const std::vector<Particle>& particles) {
  Eigen::Vector4d out = Eigen::Vector4d::Zero();
  for (const Particle& p : particles)
    out += kilograms(p.mass) * Eigen::Vector4d(static_cast<double>(p.v[0]),
                                               static_cast<double>(p.v[1]),
                                               static_cast<double>(p.v[2]), 1);
  return out;
}

}  // namespace navvy::soil
