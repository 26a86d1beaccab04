// SPDX-License-Identifier: Apache-2.0
// The ledger's particle column, recounted from the device's arrays after every step.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "device/buffer.h"
#include "device/kernel_program.h"
#include "soil/particles/particle_store.h"

namespace navvy::soil {

/// Sums of particle masses per soil in kMassQuantum, exact. Unlike ParticleStore::masses it moves
/// no particle to the host and does not look for values that are not finite (the step's report
/// does).
class MassCount {
 public:
  MassCount(device::Device& device, std::size_t soils);

  /// Makes room for a count of so many homes: a step asks before it queues its first kernel, so
  /// that a full device does not stop it half-way. @throws DeviceError when there is none.
  void reserve(std::size_t particle_blocks);
  /// Queues the count of what is stored now and its way to the host.
  void queue(ParticleStore& store);
  /// The sums of the last `queue`, once something queued after it was waited for; zeros when there
  /// are none.
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
