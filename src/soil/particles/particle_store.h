// SPDX-License-Identifier: Apache-2.0
// Particles on the device, sorted by home block.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/hash.h"
#include "core/math.h"
#include "core/state_io.h"
#include "device/buffer.h"
#include "device/program.h"
#include "soil/particles/block_table.h"
#include "soil/particles/particle.h"

namespace navvy::soil {

/// One home block as the kernels see it.
struct Home {
  std::int32_t start = 0;  ///< first slot, a multiple of NAVVY_LANES
  std::int32_t count = 0;
  std::int32_t tile = 0;  ///< first tile
  std::int32_t near = 0;  ///< 1: near a shell, three tiles
};

/// What weighing needs of a particle.
struct PointMass {
  Vec3 grid = Vec3::Zero();  ///< in G [cells]
  std::int32_t mass = 0;     ///< [kMassQuantum]
};

/// Holds all particle fields (kernels/soil/layout.h) and the block table; sorts, adds, removes, reads back.
///
/// A particle's home is the block of its base node floor(x - 0.5). The stored order is repeatable: by home, inside a
/// home by cell as of the last re-bin, inside a cell in the order of arrival. Memory is 2 x 108 bytes a particle plus
/// the tables of the touched blocks.
class ParticleStore {
 public:
  /// `site` = x and y of its lower left and its upper right corner in G [cells]; `soils` the constant table.
  ParticleStore(device::Device& device, const std::array<std::int32_t, 4>& site, const std::vector<float>& soils);

  /// Replaces everything. `homes_given`: Particle::block is the home to keep (a snapshot), else homes are found.
  void assign(const std::vector<Particle>& particles, bool homes_given = false);
  /// The order in which `assign` stores.
  static std::vector<Particle> sorted(std::vector<Particle> particles, bool homes_given = false);
  /// All particles in stored order; Particle::block is the home.
  std::vector<Particle> records() const;
  /// The homes that reach into a box of G [cells]: all particles in it, and neighbours.
  std::vector<PointMass> masses_near(const Vec3& low, const Vec3& high) const;
  /// Mass per soil, counted from the device's arrays; a particle with a value that is not finite is not counted.
  std::vector<std::int64_t> masses(std::size_t soils) const;
  /// Sorts into new homes and drops particles beyond the site's edge, which are returned.
  std::vector<Particle> rebin();
  /// Marks which homes lie near shells (one flag each) and lays out tiles. Returns the number of tiles.
  int set_near(const std::vector<std::uint8_t>& near);

  int count() const { return count_; }
  int capacity() const { return capacity_[at_]; }
  const BlockTable& table() const { return table_; }
  const std::vector<Home>& homes() const { return homes_; }
  device::Buffer<float>& state() { return state_[at_]; }
  const device::Buffer<float>& state() const { return state_[at_]; }
  device::Buffer<float>& soils() { return soils_; }
  /// Largest bank density of all soils [kg/m3].
  double densest() const;
  device::Buffer<Home>& homes_buffer() { return homes_buffer_; }
  device::Buffer<std::array<std::int32_t, 4>>& home_keys() { return home_keys_; }
  device::Buffer<float>& home_surface() { return home_surface_; }

  /// Feeds block keys and every word of every particle.
  void hash(StateHash& hash) const;

 private:
  int lay_out(const std::vector<int>& counts);
  /// The state arrays of a side hold at least `slots`, made for `wanted` when they must be made. Changes nothing when
  /// the device has no room.
  void make_room(int side, int slots, int wanted);
  void upload_homes();
  /// Four floats a home: mean tan of the tool friction angle, adhesion, 1 / bank density, 0.
  std::vector<float> surfaces(const std::vector<Particle>& sorted) const;
  std::vector<Particle> drop_outside(const std::vector<int>& counts);

  device::Device& device_;
  std::array<std::int32_t, 4> site_;
  device::Program program_;
  device::Kernel count_kernel_, gather_kernel_, move_kernel_;
  device::Buffer<float> soils_, state_[2], home_surface_;
  std::vector<float> soils_host_;
  int capacity_[2] = {0, 0};
  int at_ = 0;
  int count_ = 0;
  BlockTable table_;
  std::vector<Home> homes_;
  device::Buffer<Home> homes_buffer_, old_homes_buffer_;
  device::Buffer<std::array<std::int32_t, 4>> home_keys_;
  device::Buffer<std::uint8_t> codes_, cells_;
  device::Buffer<std::int32_t> counts_, sources_, from_;
};

}  // namespace navvy::soil
