// SPDX-License-Identifier: Apache-2.0
// Stress update of the particles, and scatter of their mass and momentum to the tiles of their
// blocks.
#pragma once

#include <cstdint>

#include "device/buffer.h"
#include "device/kernel_program.h"
#include "soil/particles/particle_store.h"

namespace navvy::soil {

/// Kernel of kernels/soil/*/particle_to_grid.cl and its results.
///
/// Every particle block scatters into tiles of its own: one tile, or three near a shell (neutral,
/// front and back particles). A tile holds the nodes that particles of the block can reach. Blocks
/// share no memory, so every sum has a fixed order and results are repeatable. Memory is 8 KiB per
/// tile.
class ParticleToGrid {
 public:
  /// Builds the kernel with the constants `scheme`. `extended_law`: true to compile the extensions
  /// of the soil law, see needs_extended_law.
  ParticleToGrid(device::Device& device, bool extended_law,
                 const SchemeConstants& scheme = kScheme);

  /// Allocates memory for this number of particle blocks and tiles.
  void set_blocks(std::size_t particle_blocks, int tiles);
  /// Queues the stress update and the scatter for a step of dt [s]; `cell`: edge of a cell [m].
  /// With `hold` (every step of a transfer except the first) only the impulse of the stresses is
  /// scattered, because the nodes still have their momentum. Writes Report.broken of every particle
  /// block.
  void enqueue(ParticleStore& store, device::Buffer<Report>& report, double dt, double cell,
               bool hold);

  /// Returns the scattered sums, TILE_NODES x 4 floats per tile: momentum [kg m/s] and mass [kg].
  device::Buffer<float>& tiles() { return tiles_; }
  /// Returns one bit mask per particle block: bit t is set if tile t of the block was written.
  device::Buffer<std::int32_t>& used() { return used_; }

 private:
  /// Device that runs the kernel.
  device::Device& device_;
  /// Constants of the particle scheme.
  SchemeConstants scheme_;
  /// Compiled program of the kernel.
  device::KernelProgram program_;
  /// Kernel that updates the stress of each particle by the soil law and scatters its mass and
  /// momentum.
  device::Kernel kernel_;
  /// TILE_NODES x 4 floats per tile: momentum [kg m/s] and mass [kg].
  device::Buffer<float> tiles_;
  /// Bit mask of the tiles that were written, one per particle block.
  device::Buffer<std::int32_t> used_;
};

}  // namespace navvy::soil
