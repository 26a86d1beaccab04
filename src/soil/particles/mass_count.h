// SPDX-License-Identifier: Apache-2.0
// Total particle mass, counted on the device once per transfer for comparison with the mass ledger.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "device/buffer.h"
#include "device/kernel_program.h"
#include "soil/particles/particle_store.h"

namespace navvy::soil {

/// Counts the exact particle mass of each soil in kMassQuantum. Unlike ParticleStore::masses it
/// copies no particles to the host, and it does not detect values that are not finite (the report
/// of a step does that).
///
/// Call `reserve` when block lists change, `queue` together with the kernels of a step, and `take`
/// after the report of that step has been read.
class MassCount {
 public:
  /// Builds the kernel. `soils`: number of soils of the scene.
  MassCount(device::Device& device, std::size_t soils);

  /// Allocates memory for the count over `particle_blocks` blocks. Call it before the first kernel
  /// of a step is queued, so that a full device does not stop the step half-way.
  /// @throws DeviceError when the device has no memory.
  void reserve(std::size_t particle_blocks);
  /// Queues the count of all stored particles and the copy of its result to the host; does not
  /// wait.
  void queue(ParticleStore& store);
  /// Returns the masses of the last `queue`, one entry per soil; all zero if nothing was queued.
  /// Before the call, the host must have waited for the device after that `queue`.
  std::vector<std::int64_t> take();

 private:
  /// Device that runs the kernel.
  device::Device& device_;
  /// Number of soils.
  std::size_t soils_;
  /// Compiled program of the kernel.
  device::KernelProgram program_;
  /// Kernel that sums the masses of each block.
  device::Kernel kernel_;
  /// Masses per particle block and soil [kMassQuantum].
  device::Buffer<std::int64_t> masses_;
  /// masses_ as mapped for the host, between `queue` and `take`.
  std::optional<device::Mapped<const std::int64_t>> sums_;
};

}  // namespace navvy::soil
