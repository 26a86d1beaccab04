// SPDX-License-Identifier: Apache-2.0
// Node data that exists only in near blocks: the active blocks whose nodes a tool's shell may
// touch.
#pragma once

#include <cstddef>
#include <cstdint>

#include "device/buffer.h"
#include "soil/layout.h"

namespace navvy::soil {

/// Node data of the near blocks, shared by transfer and contact. Unless stated otherwise an array
/// has BLOCK_NODES entries per near block, in the order of `list`. Parentheses name the writer of
/// an array: the host or a kernel.
struct NearNodes {
  /// Number of near blocks.
  int count = 0;
  /// True if the step must compute what stays the same for the rest of a transfer: masses per free
  /// volume, contact properties of nodes and lists of contacts. It is true in the first step of a
  /// transfer, after a load, and after a change of the ground.
  bool renew = true;
  /// Active-block index of each near block, ascending (host).
  device::Buffer<std::int32_t> list;
  /// One entry per active block: the block's index in the near arrays, or -1 if the block is not
  /// near (host).
  device::Buffer<std::int32_t> slot;
  /// Velocity fields of each node: 0 one field; 1 two fields, the node itself is in front of the
  /// plate; 2 two fields, the node is behind the plate (kernel shell_nodes).
  device::Buffer<std::int32_t> split;
  /// Four floats per node: velocity after gravity and before contact [m/s], and mass [kg]. before0
  /// holds the front field (or the only one), before1 the back field (kernel grid_update_near).
  device::Buffer<float> before0, before1;
  /// Contact properties of the soil at each node: the mass-weighted mean over the particle blocks
  /// around it (kernel grid_update_near).
  device::Buffer<ContactSoil> surface;
  /// Four floats per node, like GridUpdate::velocity: the velocity that particles behind a shell
  /// receive (kernel contact_apply).
  device::Buffer<float> velocity1;
  /// Returns the number of floats in an array with four floats per near node.
  std::size_t values() const { return static_cast<std::size_t>(count) * 4 * BLOCK_NODES; }
};

}  // namespace navvy::soil
