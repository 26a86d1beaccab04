// SPDX-License-Identifier: Apache-2.0
// Gather of node velocities to particles, and the way they go at a transfer's end.
#pragma once

#include <cstdint>

#include "device/buffer.h"
#include "device/kernel_program.h"
#include "soil/particles/near_nodes.h"
#include "soil/particles/particle_store.h"

namespace navvy::soil {

/// The kernel of kernels/soil/*/grid_to_particle.cl.
class GridToParticle {
 public:
  explicit GridToParticle(device::Device& device);

  /// Takes over which active blocks lie around each home.
  void set_blocks(const BlockTable& table);
  /// Queues gather of a step of dt [s], the share `part` of a transfer, whose way is booked.
  /// `velocity`: GridUpdate::velocity; `used`: ParticleToGrid::used. Writes Report.speed of every
  /// home.
  void enqueue(ParticleStore& store, device::Buffer<float>& velocity, NearNodes& near,
               device::Buffer<std::int32_t>& used, device::Buffer<Report>& report, double dt,
               double part, double cell);
  /// Queues that particles go the way that was booked: the transfer ends, and what was held may
  /// change.
  void enqueue_end(ParticleStore& store);

 private:
  device::Device& device_;
  device::KernelProgram program_;
  device::Kernel kernel_, end_kernel_;
  device::Buffer<std::int32_t> neighbours_;  ///< 27 active indices per home
};

}  // namespace navvy::soil
