// SPDX-License-Identifier: Apache-2.0
// Arrays of node data that exist only in active blocks near shells.
#pragma once

#include <cstddef>
#include <cstdint>

#include "device/buffer.h"
#include "soil/layout.h"

namespace navvy::soil {

/// What transfer and contact hand each other, BLOCK_NODES per near active block unless said.
struct NearNodes {
  int count = 0;                      ///< near active blocks
  device::Buffer<std::int32_t> list;  ///< their active indices, ascending (the host)
  /// Per active block: index into the near arrays or -1 (the host).
  device::Buffer<std::int32_t> slot;
  device::Buffer<std::int32_t> split;  ///< 0, 1 in front, 2 behind (shell_nodes)
  /// float4 per node: v after gravity [m/s], m [kg] (grid_update_near).
  device::Buffer<float> before0, before1;
  device::Buffer<ContactSoil> surface;  ///< mean by mass of the homes around (grid_update_near)
  /// float4: what particles behind a shell feel (contact_apply).
  device::Buffer<float> velocity1;
  /// Numbers of an array of float4s.
  std::size_t values() const { return static_cast<std::size_t>(count) * 4 * BLOCK_NODES; }
};

}  // namespace navvy::soil
