// SPDX-License-Identifier: Apache-2.0
// Stress update of particles and scatter of their mass and momentum to the tiles of their homes.
#pragma once

#include <cstdint>

#include "device/buffer.h"
#include "device/kernel_program.h"
#include "soil/particles/particle_store.h"

namespace navvy::soil {

/// The kernel of kernels/soil/*/particle_to_grid.cl and what it writes.
class ParticleToGrid {
 public:
  /// `extended_law`: see needs_extended_law.
  ParticleToGrid(device::Device& device, bool extended_law);

  /// Makes room for this many homes and tiles.
  void set_blocks(std::size_t particle_blocks, int tiles);
  /// Queues law and scatter of a step of dt [s] on cells of `cell` [m]; of a `hold` step only what
  /// stress adds to the momentum of the nodes. Writes Report.broken of every home.
  void enqueue(ParticleStore& store, device::Buffer<Report>& report, double dt, double cell,
               bool hold);

  device::Buffer<float>& tiles() { return tiles_; }
  device::Buffer<std::int32_t>& used() { return used_; }

 private:
  device::Device& device_;
  device::KernelProgram program_;
  device::Kernel kernel_;
  device::Buffer<float> tiles_;        ///< TILE_NODES float4s a tile: p [kg m/s], m [kg]
  device::Buffer<std::int32_t> used_;  ///< per home: bits of its tiles that were written
};

}  // namespace navvy::soil
