// SPDX-License-Identifier: Apache-2.0
// Node data that exists only in active blocks near shells.
#pragma once

#include <cstddef>
#include <cstdint>

#include "device/buffer.h"
#include "soil/layout.h"

namespace navvy::soil {

/// Data shared by transfer and contact, BLOCK_NODES per near active block unless stated otherwise.
/// Names in parentheses say what writes an array.
struct NearNodes {
  /// Number of near active blocks.
  int count = 0;
  /// Their active-block indices, ascending (host).
  device::Buffer<std::int32_t> list;
  /// Index into the near arrays or -1, per active block (host).
  device::Buffer<std::int32_t> slot;
  /// 0 unsplit, 1 in front, 2 behind (shell_nodes).
  device::Buffer<std::int32_t> split;
  /// float4 per node: v after gravity [m/s], m [kg] (grid_update_near).
  device::Buffer<float> before0, before1;
  /// Mean by mass of the particle blocks around (grid_update_near).
  device::Buffer<ContactSoil> surface;
  /// float4: velocity that particles behind a shell see (contact_apply).
  device::Buffer<float> velocity1;
  /// Returns the number of floats in an array of float4s.
  std::size_t values() const { return static_cast<std::size_t>(count) * 4 * BLOCK_NODES; }
};

}  // namespace navvy::soil
