// SPDX-License-Identifier: Apache-2.0
// Where nodes and particles lie relative to the shells of tools, on the device.
#pragma once

#include <cstdint>
#include <vector>

#include "device/buffer.h"
#include "device/kernel_program.h"
#include "soil/particles/near_nodes.h"
#include "soil/particles/particle_store.h"
#include "soil/particles/transfer.h"
#include "soil/tool.h"

namespace navvy::soil {

/// Tools as the kernels take them in one step. Triangles of all tools count on from one another.
struct ToolShells {
  std::vector<ShellTriangle> triangles;
  std::vector<ShellRim> rims;
  std::vector<Tool> tools;
};

/// Compressed rows: candidates of row r stand from first[r] up to first[r + 1].
struct CandidateRows {
  std::vector<std::int32_t> first, triangles;
};

/// The kernels of kernels/soil/*/shell.cl, what they read of tools and what they write of near
/// nodes.
class ShellQuery {
 public:
  explicit ShellQuery(device::Device& device);

  /// Which triangles may be near the near active blocks and the near homes, whose indices among
  /// homes are `near_particle_blocks`.
  void set_near(const CandidateRows& node_candidates, const CandidateRows& particle_candidates,
                const std::vector<std::int32_t>& near_particle_blocks);
  /// Takes over the tools of the step without waiting; the two-way solve changes their twists on
  /// the device.
  void set_tools(ToolShells shells);
  /// Takes over new twists and places of the same tools without waiting; the plates stay where they
  /// are.
  void set_twists(std::vector<Tool> tools);
  /// Queues split, tool and place of near nodes.
  void enqueue_nodes(Transfer& transfer, NearNodes& near, double band);
  /// Queues both kernels: split, tool and place of near nodes, then side and position of particles,
  /// with Report.push and Report.crossed of near homes. `band`, `longest_push` in cells, see
  /// ContactSettings.
  void enqueue(ParticleStore& store, Transfer& transfer, NearNodes& near, double band,
               double longest_push);

  device::Buffer<Tool>& tools() { return tools_; }
  device::Buffer<std::int32_t>& node_tool() { return node_tool_; }
  device::Buffer<NodeShell>& node_shell() { return node_shell_; }

 private:
  device::Device& device_;
  device::KernelProgram program_;
  device::Kernel nodes_kernel_, particles_kernel_;
  ToolShells now_;  ///< what the device may still be reading
  std::size_t near_particle_blocks_ = 0;
  // The host writes these.
  device::Buffer<ShellTriangle> triangles_;
  device::Buffer<ShellRim> rims_;
  device::Buffer<Tool> tools_;  ///< the twists: contact_twist, too
  /// CandidateRows of near active blocks.
  device::Buffer<std::int32_t> block_first_, block_triangles_;
  device::Buffer<std::int32_t> particle_first_, particle_triangles_;  ///< of near homes
  /// Near homes: index among homes.
  device::Buffer<std::int32_t> particle_block_list_;
  // shell_nodes writes these, BLOCK_NODES per near active block.
  device::Buffer<std::int32_t> node_tool_;  ///< tool of the closest triangle, -1: none
  device::Buffer<NodeShell> node_shell_;    ///< where there is one
};

}  // namespace navvy::soil
