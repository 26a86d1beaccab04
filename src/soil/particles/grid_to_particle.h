// SPDX-License-Identifier: Apache-2.0
// Gather of node velocities to particles, and their displacement at the end of a transfer.
#pragma once

#include <cstdint>

#include "device/buffer.h"
#include "device/kernel_program.h"
#include "soil/particles/near_nodes.h"
#include "soil/particles/particle_store.h"

namespace navvy::soil {

/// Kernels of kernels/soil/*/grid_to_particle.cl.
///
/// Particles keep their position during a transfer: their displacement is summed in `moved`, and
/// enqueue_end adds it. A block reads only nodes of its own active neighbours and writes only its
/// own particles.
class GridToParticle {
 public:
  /// Builds the kernels with these constants.
  explicit GridToParticle(device::Device& device, const SchemeConstants& scheme = kScheme);

  /// Uploads the active blocks around each particle block.
  void set_blocks(const BlockTable& table);
  /// Queues the gather of a step of dt [s], which is the share `part` of a transfer, and records
  /// displacements. `velocity`: GridUpdate::velocity; `used`: ParticleToGrid::used. Writes
  /// Report.speed of every block.
  void enqueue(ParticleStore& store, device::Buffer<float>& velocity, NearNodes& near,
               device::Buffer<std::int32_t>& used, device::Buffer<Report>& report, double dt,
               double part, double cell);
  /// Queues the end of a transfer: particles move by their recorded displacement, and lists may
  /// change.
  void enqueue_end(ParticleStore& store);

 private:
  device::Device& device_;
  SchemeConstants scheme_;
  device::KernelProgram program_;
  device::Kernel kernel_, end_kernel_;
  /// 27 active-block indices per particle block.
  device::Buffer<std::int32_t> neighbours_;
};

}  // namespace navvy::soil
