// SPDX-License-Identifier: Apache-2.0
// Stress update of particles and scatter of their mass and momentum to the tiles of their blocks.
#pragma once

#include <cstdint>

#include "device/buffer.h"
#include "device/kernel_program.h"
#include "soil/particles/particle_store.h"

namespace navvy::soil {

/// Kernel of kernels/soil/*/particle_to_grid.cl and its results.
///
/// Every block scatters into tiles of its own, one or, near a shell, three. Nothing is shared
/// between blocks, so sums have one order and results repeat. Memory is 8 KiB per tile.
class ParticleToGrid {
 public:
  /// Builds the kernel. `extended_law`: see needs_extended_law.
  ParticleToGrid(device::Device& device, bool extended_law,
                 const SchemeConstants& scheme = kScheme);

  /// Allocates memory for this many blocks and tiles.
  void set_blocks(std::size_t particle_blocks, int tiles);
  /// Queues law and scatter of a step of dt [s] on cells of `cell` [m]. In a `hold` step only
  /// stress adds to the momentum of the nodes. Writes Report.broken of every block.
  void enqueue(ParticleStore& store, device::Buffer<Report>& report, double dt, double cell,
               bool hold);

  device::Buffer<float>& tiles() { return tiles_; }
  device::Buffer<std::int32_t>& used() { return used_; }

 private:
  device::Device& device_;
  SchemeConstants scheme_;
  device::KernelProgram program_;
  device::Kernel kernel_;
  /// TILE_NODES float4s per tile: p [kg m/s], m [kg].
  device::Buffer<float> tiles_;
  /// Bits of the tiles that were written, per block.
  device::Buffer<std::int32_t> used_;
};

}  // namespace navvy::soil
