// SPDX-License-Identifier: Apache-2.0
// Particles on the device, sorted by home block.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/math.h"
#include "device/buffer.h"
#include "soil/layout.h"
#include "soil/particles/block_table.h"
#include "soil/particles/particle.h"
#include "soil/particles/rebin.h"

namespace navvy {
class Archive;
}

namespace navvy::soil {

/// What weighing needs of a particle.
struct PointMass {
  Vec3 grid = Vec3::Zero();  ///< in G [cells]
  std::int32_t mass = 0;     ///< [kMassQuantum]
};

/// Holds all particle fields (kernels/soil/layout.h) and the block table; sorts, adds, removes,
/// reads back.
///
/// A particle's home is the block of its base node floor(x - 0.5). The stored order is repeatable:
/// by home, inside a home by cell as of the last re-bin, inside a cell in the order of arrival.
/// Memory is 2 x 120 bytes a particle plus the tables of the touched blocks.
class ParticleStore {
 public:
  /// `site` = x and y of its lower left and its upper right corner in G [cells]; `soils` the
  /// constant table.
  ParticleStore(device::Device& device, const std::array<std::int32_t, 4>& site,
                const std::vector<SoilRow>& soils);

  /// Replaces everything; finds homes and sorts. @throws DeviceError when the device has no room;
  /// then the store holds what it held before, as after a `rebin` that throws.
  void assign(const std::vector<Particle>& particles) { place(sorted(particles)); }
  /// The same of particles that lie as `sorted` and `records` give them: Particle::block is the
  /// home to keep, homes ascend, and the order inside them stays.
  void place(const std::vector<Particle>& sorted);
  /// The order in which `assign` stores.
  static std::vector<Particle> sorted(std::vector<Particle> particles);
  /// All particles in stored order; Particle::block is the home.
  std::vector<Particle> records() const;
  /// The homes that reach into a box of G [cells]: all particles in it, and neighbours.
  std::vector<PointMass> masses_near(const Vec3& low, const Vec3& high) const;
  /// Mass per soil, counted from the device's arrays; a particle with a value that is not finite is
  /// not counted.
  std::vector<std::int64_t> masses(std::size_t soils) const;
  /// Sorts into new homes and drops particles beyond the site's edge, which are returned.
  std::vector<Particle> rebin();
  /// Marks which homes lie near shells (one flag each) and lays out tiles. Returns the number of
  /// tiles.
  int set_near(const std::vector<std::uint8_t>& near);

  int count() const { return count_; }
  int capacity() const { return capacity_[now_]; }
  const BlockTable& table() const { return table_; }
  const std::vector<ParticleBlock>& particle_blocks() const { return particle_blocks_; }
  device::Buffer<float>& state() { return state_[now_]; }
  const device::Buffer<float>& state() const { return state_[now_]; }
  device::Buffer<SoilRow>& soils() { return soils_; }
  /// Largest bank density of all soils [kg/m3].
  double densest() const;
  device::Buffer<ParticleBlock>& particle_blocks_buffer() { return particle_blocks_buffer_; }
  device::Buffer<std::array<std::int32_t, 4>>& block_keys() { return block_keys_; }
  device::Buffer<ContactSoil>& block_surface() { return block_surface_; }

  /// Home by home the block and every word of every particle as it stands on the device; padding
  /// and room to spare are not state. @throws InputError for homes that do not ascend or a soil
  /// that the scene does not have.
  void visit(Archive& a);
  /// The same of particles on the host: `records` are sorted by home, as from `sorted` or
  /// `records()`.
  static void visit(Archive& a, std::vector<Particle>& records, std::size_t soils);

 private:
  /// Homes of the table, with so many particles each. @pre the buffers have room.
  void lay_out(const std::vector<int>& counts);
  /// The state arrays of a side hold at least `slots`, made for `wanted` when they must be made.
  /// Changes nothing when the device has no room.
  void reserve(int side, int slots, int wanted);
  void upload_particle_blocks();  ///< @pre their buffers have room
  /// Mean over the particles of each home.
  std::vector<ContactSoil> surfaces(const std::vector<Particle>& sorted) const;
  std::vector<Particle> drop_outside();

  device::Device& device_;
  std::array<std::int32_t, 4> site_;
  Rebin rebin_;
  // On the device; written by `assign` and by re-binning, the state by the transfer in every step,
  // too.
  device::Buffer<SoilRow> soils_;  ///< one per soil, constant
  /// FIELD_COUNT x capacity words, field after field (particle_fields.h).
  device::Buffer<float> state_[2];
  device::Buffer<ContactSoil> block_surface_;  ///< one per home, mean over its particles
  std::vector<SoilRow> soil_rows_;
  int capacity_[2] = {0, 0};
  int now_ = 0;  ///< which of the two states stands; re-binning writes the other
  int count_ = 0;
  BlockTable table_;
  std::vector<ParticleBlock> particle_blocks_;
  /// One per home, as `homes_`; before the last re-bin.
  device::Buffer<ParticleBlock> particle_blocks_buffer_, old_particle_blocks_buffer_;
  device::Buffer<std::array<std::int32_t, 4>> block_keys_;  ///< block (x, y, z, 0) of each home
};

}  // namespace navvy::soil
