// SPDX-License-Identifier: Apache-2.0
// Mass of all particles, counted on the device once per transfer for the ledger.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "device/buffer.h"
#include "device/kernel_program.h"
#include "soil/particles/particle_store.h"

namespace navvy::soil {

/// Exact sums of particle masses per soil in kMassQuantum. Unlike ParticleStore::masses it copies
/// no particle to the host and does not look for values that are not finite (the report of a step
/// does).
///
/// Usage: `reserve` when lists change, `queue` with the kernels of a step, `take` after the report
/// of that step has been read.
class MassCount {
 public:
  /// Builds the kernel. `soils`: number of soils.
  MassCount(device::Device& device, std::size_t soils);

  /// Reserves memory for a count of this many blocks. A step does so before it queues its first
  /// kernel, so that a full device does not stop it half-way.
  /// @throws DeviceError when there is no memory.
  void reserve(std::size_t particle_blocks);
  /// Queues the count of the stored particles and its copy to the host.
  void queue(ParticleStore& store);
  /// Returns the sums of the last `queue`, after a wait for something queued later; zeros when
  /// there are none.
  std::vector<std::int64_t> take();

 private:
  device::Device& device_;
  std::size_t soils_;
  device::KernelProgram program_;
  device::Kernel kernel_;
  device::Buffer<std::int64_t> masses_;
  std::optional<device::Mapped<const std::int64_t>> sums_;
};

}  // namespace navvy::soil
