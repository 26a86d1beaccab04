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

/// Position and mass of a particle, for weighing the contents of tools.
struct PointMass {
  /// Current position in G [cells].
  Vec3 grid = Vec3::Zero();
  /// Mass [kMassQuantum].
  std::int32_t mass = 0;
};

/// Stores all fields of the particles (kernels/soil/particle_fields.h) and the block table on the
/// device; sorts, adds, removes and reads particles.
///
/// A particle is stored in the block that contains its base node floor(x - 0.5), the lowest node
/// that it exchanges momentum with. The stored order is repeatable: by block, within a block by
/// cell as of the last re-bin, within a cell in the order of arrival. Memory is 2 x 120 bytes per
/// particle plus the block tables.
class ParticleStore {
 public:
  /// Creates an empty store. `site`: x and y of the site's lower-left corner, then x and y of its
  /// upper-right corner, in G [cells]; `soils`: constants of each soil, by soil index.
  ParticleStore(device::Device& device, const std::array<std::int32_t, 4>& site,
                const std::vector<SoilRow>& soils);

  /// Replaces all particles: finds the block of each particle and sorts them.
  /// @throws DeviceError when the device has no memory. The store then keeps its previous contents,
  /// as it does when `rebin` throws.
  void assign(const std::vector<Particle>& particles) { place(sorted(particles)); }
  /// Replaces all particles by `sorted`, which must be ordered as `sorted()` or `records()` returns
  /// them: Particle::block is the block to store the particle in, and block keys ascend. The order
  /// within a block is preserved.
  void place(const std::vector<Particle>& sorted);
  /// Returns `particles` in the order in which `assign` stores them, each with the block that it is
  /// stored in.
  static std::vector<Particle> sorted(std::vector<Particle> particles);
  /// Removes the particles whose flag in `removed` is not 0, and adds `added`. Stores the same as
  /// `assign` of the particles that stay followed by `added`, but on the device: only flags and
  /// added particles are copied to it. `removed`: one flag per particle in stored order, or empty;
  /// particles must have moved by less than a cell since they were last sorted.
  /// @throws DeviceError when the device has no memory. The store then keeps its contents.
  void change(const std::vector<std::uint8_t>& removed, const std::vector<Particle>& added);
  /// Returns host copies of all particles in stored order. Particle::block is the block that a
  /// particle is stored in.
  std::vector<Particle> records() const;
  /// Replaces the contents of `out` by host copies of all particles in stored order, with what the
  /// exchange needs: block, x, v, j0, shear, mass, soil, side and ID. Other members are those that
  /// `out` held, or defaults. Reads a third of the words that `records` copies.
  void exchange_records(std::vector<Particle>& out) const;
  /// Returns the particles inside the box `low` .. `high` of G [cells]. Reads a quarter of the
  /// words that `records` copies.
  std::vector<PointMass> masses_near(const Vec3& low, const Vec3& high) const;
  /// Replaces the contents of `out` by the places of all particles, in stored order. Reads a third
  /// of the words that `records` copies.
  void places(std::vector<ParticlePlace>& out) const;
  /// Returns the total particle mass of each of `soils` soils [kMassQuantum], counted from the
  /// device's arrays. A particle with a value that is not finite is not counted.
  std::vector<std::int64_t> masses(std::size_t soils) const;
  /// Sorts the particles into the blocks of their positions on the device. Removes particles
  /// outside the site and returns them.
  std::vector<Particle> rebin();
  /// Marks the blocks near shells and assigns tiles to all blocks: three to a near block, one to
  /// any other. `near`: one flag per particle block, not 0 if near. Returns the total number of
  /// tiles.
  int set_near(const std::vector<std::uint8_t>& near);

  /// Returns the number of particles.
  int count() const { return count_; }
  /// Returns the number of particle slots in the state array, used or not.
  int capacity() const { return capacity_[now_]; }
  /// Returns the table of particle blocks and active blocks.
  const BlockTable& table() const { return table_; }
  /// Returns slots, particle count and tiles of each particle block.
  const std::vector<ParticleBlock>& particle_blocks() const { return particle_blocks_; }
  /// Returns the state array on the device: FIELD_COUNT x capacity() words, field by field.
  device::Buffer<float>& state() { return state_[now_]; }
  /// Returns the state array on the device: FIELD_COUNT x capacity() words, field by field.
  const device::Buffer<float>& state() const { return state_[now_]; }
  /// Returns the constants of each soil on the device, by soil index.
  device::Buffer<SoilRow>& soils() { return soils_; }
  /// Returns the largest bank density of all soils [kg/m3].
  double densest() const;
  /// Returns particle_blocks() on the device.
  device::Buffer<ParticleBlock>& particle_blocks_buffer() { return particle_blocks_buffer_; }
  /// Returns the key (x, y, z, 0) of each particle block, on the device.
  device::Buffer<std::array<std::int32_t, 4>>& block_keys() { return block_keys_; }
  /// Returns the contact properties of the soil in each particle block, averaged over its
  /// particles, on the device.
  device::Buffer<ContactSoil>& block_surface() { return block_surface_; }

  /// Visits every word of every particle, block by block, exactly as on the device. Padding and
  /// spare memory are not part of the state.
  /// @throws InputError for blocks that do not ascend and for a soil that the scene does not have.
  void visit(Archive& a);
  /// Visits particles on the host in the same format. `records` must be ordered as `sorted()` or
  /// `records()` returns them; `soils`: number of soils.
  static void visit(Archive& a, std::vector<Particle>& records, std::size_t soils);

 private:
  /// Assigns slots to the blocks of the table; `counts`: number of particles per block. @pre The
  /// buffers are large enough.
  void assign_slots(const std::vector<int>& counts);
  /// Makes state array `side` (0 or 1) hold at least `slots` slots; if it must be reallocated, it
  /// gets `wanted` slots. Its contents are undefined afterwards. If the device has no memory, the
  /// call throws and changes nothing.
  void reserve(int side, int slots, int wanted);
  /// Uploads particle_blocks_ and the block keys. @pre The buffers are large enough.
  void upload_particle_blocks();
  /// Returns the contact properties of each particle block: the mean over its particles.
  std::vector<ContactSoil> surfaces(const std::vector<Particle>& sorted) const;
  /// Removes particles outside the site and returns them.
  std::vector<Particle> drop_outside();
  /// Moves the particles, as the re-bin has counted them, and those of `added` into new blocks.
  void move(const RebinPlan& plan, const AddedParticles& added);

  /// Device that stores the particles.
  device::Device& device_;
  /// Lower-left x and y, upper-right x and y of the site in G [cells].
  std::array<std::int32_t, 4> site_;
  /// Kernels that sort particles into new blocks.
  Rebin rebin_;
  /// Constants of each soil on the device; never changed.
  device::Buffer<SoilRow> soils_;
  /// Two state arrays of FIELD_COUNT x capacity words, field by field (particle_fields.h). Every
  /// step writes the current one; a re-bin copies all particles into the other one.
  device::Buffer<float> state_[2];
  /// Contact properties of each particle block, the mean over its particles. `place` and `rebin`
  /// write them.
  device::Buffer<ContactSoil> block_surface_;
  /// Host copy of soils_.
  std::vector<SoilRow> soil_rows_;
  /// Number of slots of each state array.
  int capacity_[2] = {0, 0};
  /// Index of the current state array, 0 or 1.
  int now_ = 0;
  /// Number of particles.
  int count_ = 0;
  /// Particle blocks and active blocks.
  BlockTable table_;
  /// Slots, count and tiles of each particle block (host).
  std::vector<ParticleBlock> particle_blocks_;
  /// One entry per particle block: particle_blocks_buffer_ is the current list,
  /// old_particle_blocks_buffer_ the list before the last re-bin.
  device::Buffer<ParticleBlock> particle_blocks_buffer_, old_particle_blocks_buffer_;
  /// Key (x, y, z, 0) of each particle block.
  device::Buffer<std::array<std::int32_t, 4>> block_keys_;
};

}  // namespace navvy::soil
