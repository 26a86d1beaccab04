// SPDX-License-Identifier: Apache-2.0
// Gather of node velocities to particles, and displacement of the particles at the end of a
// transfer.
#pragma once

#include <cstdint>

#include "device/buffer.h"
#include "device/kernel_program.h"
#include "soil/particles/near_nodes.h"
#include "soil/particles/particle_store.h"

namespace navvy::soil {

/// Kernels of kernels/soil/*/grid_to_particle.cl.
///
/// Particles keep their position during a transfer. `enqueue` sums their displacement in the field
/// `moved`, and `enqueue_end` adds that sum to the position. A particle block reads only the nodes
/// of its own 27 active neighbours and writes only its own particles.
class GridToParticle {
 public:
  /// Builds the kernels with the constants `scheme`.
  explicit GridToParticle(device::Device& device, const SchemeConstants& scheme = kScheme);

  /// Uploads the active-block indices of the 27 neighbours of each particle block.
  void set_blocks(const BlockTable& table);
  /// Queues the gather of a step of dt [s] and records the displacements. Writes Report.speed of
  /// every particle block.
  ///
  /// `velocity`: GridUpdate::velocity; `used`: ParticleToGrid::used; `part`: dt / length of the
  /// transfer, with which crowded particles are separated (0: not at all); `cell`: edge of a cell
  /// [m].
  void enqueue(ParticleStore& store, device::Buffer<float>& velocity, NearNodes& near,
               device::Buffer<std::int32_t>& used, device::Buffer<Report>& report, double dt,
               double part, double cell);
  /// Queues the end of a transfer: adds the recorded displacement of each particle to its position.
  void enqueue_end(ParticleStore& store);

 private:
  /// Device that runs the kernels.
  device::Device& device_;
  /// Constants of the particle scheme.
  SchemeConstants scheme_;
  /// Compiled program of both kernels.
  device::KernelProgram program_;
  /// Kernels: kernel_ gathers, end_kernel_ moves the particles.
  device::Kernel kernel_, end_kernel_;
  /// BlockTable::neighbours on the device: 27 active-block indices per particle block.
  device::Buffer<std::int32_t> neighbours_;
};

}  // namespace navvy::soil
