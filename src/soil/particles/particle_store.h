// SPDX-License-Identifier: Apache-2.0
// Particles on the device, sorted by block.
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

/// Position and mass of a particle, enough for weighing.
struct PointMass {
  /// Position in G [cells].
  Vec3 grid = Vec3::Zero();
  /// [kMassQuantum].
  std::int32_t mass = 0;
};

/// Holds all particle fields (kernels/soil/layout.h) and the block table; sorts, adds, removes and
/// reads particles.
///
/// A particle is stored in the block of its base node floor(x - 0.5). The stored order is
/// repeatable: by block, inside a block by cell as of the last re-bin, inside a cell in the order
/// of arrival. Memory is 2 x 120 bytes per particle plus the tables of the blocks.
class ParticleStore {
 public:
  /// Creates an empty store. `site`: x and y of its lower left and its upper right corner in G
  /// [cells]; `soils`: the constant table.
  ParticleStore(device::Device& device, const std::array<std::int32_t, 4>& site,
                const std::vector<SoilRow>& soils);

  /// Replaces all particles; finds their blocks and sorts them.
  /// @throws DeviceError when the device has no memory. The store then keeps its contents, as after
  /// a `rebin` that throws.
  void assign(const std::vector<Particle>& particles) { place(sorted(particles)); }
  /// Replaces all particles by those that are already sorted, as from `sorted` and `records`:
  /// Particle::block is the block to store them in, blocks ascend, and the order inside them is
  /// kept.
  void place(const std::vector<Particle>& sorted);
  /// Returns particles in the order in which `assign` stores them.
  static std::vector<Particle> sorted(std::vector<Particle> particles);
  /// Returns all particles in stored order; Particle::block is the block they are stored in.
  std::vector<Particle> records() const;
  /// Returns the particles of all blocks that reach into a box of G [cells]: all particles in it,
  /// and neighbours.
  std::vector<PointMass> masses_near(const Vec3& low, const Vec3& high) const;
  /// Returns the mass per soil, counted from the device's arrays. A particle with a value that is
  /// not finite is not counted.
  std::vector<std::int64_t> masses(std::size_t soils) const;
  /// Sorts particles into new blocks and removes those beyond the site's edge, which are returned.
  std::vector<Particle> rebin();
  /// Marks the blocks near shells (one flag each) and assigns tiles. Returns the number of tiles.
  int set_near(const std::vector<std::uint8_t>& near);

  /// Returns the number of particles.
  int count() const { return count_; }
  /// Returns the number of slots of the state array.
  int capacity() const { return capacity_[now_]; }
  /// Returns the particle blocks and active blocks.
  const BlockTable& table() const { return table_; }
  const std::vector<ParticleBlock>& particle_blocks() const { return particle_blocks_; }
  /// Returns the state array: FIELD_COUNT x capacity words.
  device::Buffer<float>& state() { return state_[now_]; }
  const device::Buffer<float>& state() const { return state_[now_]; }
  /// Returns the constant table of soils.
  device::Buffer<SoilRow>& soils() { return soils_; }
  /// Returns the largest bank density of all soils [kg/m3].
  double densest() const;
  device::Buffer<ParticleBlock>& particle_blocks_buffer() { return particle_blocks_buffer_; }
  device::Buffer<std::array<std::int32_t, 4>>& block_keys() { return block_keys_; }
  device::Buffer<ContactSoil>& block_surface() { return block_surface_; }

  /// Visits block by block every word of every particle as it is on the device. Padding and spare
  /// memory are not state.
  /// @throws InputError for blocks that do not ascend or a soil that the scene does not have.
  void visit(Archive& a);
  /// Visits particles on the host in the same format. `records` are sorted by block, as from
  /// `sorted` or `records()`.
  static void visit(Archive& a, std::vector<Particle>& records, std::size_t soils);

 private:
  /// Assigns slots to the blocks of the table, with these counts. @pre The buffers are large
  /// enough.
  void assign_slots(const std::vector<int>& counts);
  /// Makes the state arrays of a side hold at least `slots`; allocates for `wanted` if it must.
  /// Changes nothing when the device has no memory.
  void reserve(int side, int slots, int wanted);
  /// @pre Their buffers are large enough.
  void upload_particle_blocks();
  /// Returns the mean surface over the particles of each block.
  std::vector<ContactSoil> surfaces(const std::vector<Particle>& sorted) const;
  /// Removes particles beyond the site's edge and returns them.
  std::vector<Particle> drop_outside();

  device::Device& device_;
  std::array<std::int32_t, 4> site_;
  Rebin rebin_;
  // On the device. `assign` and re-binning write them; every step writes the state.
  /// One per soil, constant.
  device::Buffer<SoilRow> soils_;
  /// FIELD_COUNT x capacity words, field after field (particle_fields.h).
  device::Buffer<float> state_[2];
  /// One per block, mean over its particles.
  device::Buffer<ContactSoil> block_surface_;
  std::vector<SoilRow> soil_rows_;
  /// Slots of the two state arrays.
  int capacity_[2] = {0, 0};
  /// Index of the current one of the two states; re-binning writes the other.
  int now_ = 0;
  int count_ = 0;
  BlockTable table_;
  std::vector<ParticleBlock> particle_blocks_;
  /// One per block: current, and before the last re-bin.
  device::Buffer<ParticleBlock> particle_blocks_buffer_, old_particle_blocks_buffer_;
  /// Block (x, y, z, 0) of each entry.
  device::Buffer<std::array<std::int32_t, 4>> block_keys_;
};

}  // namespace navvy::soil
