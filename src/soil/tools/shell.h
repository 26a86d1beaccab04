// SPDX-License-Identifier: Apache-2.0
// Positions of nodes and particles relative to the shells of tools, on the device.
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

/// Tools as the kernels take them in one step. Triangles are numbered over all tools.
struct ToolShells {
  /// Triangles of all tools.
  std::vector<ShellTriangle> triangles;
  /// Free edges of all tools.
  std::vector<ShellRim> rims;
  /// One per tool.
  std::vector<Tool> tools;
};

/// Compressed rows: the candidates of row r are first[r] .. first[r + 1] - 1.
struct CandidateRows {
  std::vector<std::int32_t> first, triangles;
};

/// Kernels of kernels/soil/*/shell.cl, their data of tools, and their results for near nodes.
///
/// Arrays of near nodes have BLOCK_NODES entries per near active block, in the order of
/// NearNodes::list. Kernels write them in the first step of a transfer only.
class ShellQuery {
 public:
  /// Builds the kernels with these constants.
  explicit ShellQuery(device::Device& device, const SchemeConstants& scheme = kScheme);

  /// Uploads the triangles that may be near the near active blocks and the near particle blocks,
  /// whose indices are `near_particle_blocks`.
  void set_near(const CandidateRows& node_candidates, const CandidateRows& particle_candidates,
                const std::vector<std::int32_t>& near_particle_blocks);
  /// Uploads the tools of the step without waiting. The two-way solve changes their twists on the
  /// device.
  void set_tools(ToolShells shells);
  /// Uploads new twists and positions of the same tools without waiting; the plates stay.
  void set_twists(std::vector<Tool> tools);
  /// Queues split, tool and NodeShell of near nodes.
  void enqueue_nodes(Transfer& transfer, NearNodes& near, double band);
  /// Queues both kernels: split, tool and NodeShell of near nodes, then side and position of
  /// particles, with Report.push and Report.crossed of near blocks. `band`, `longest_push` [cells]:
  /// contact_band and contact_max_push of the scheme.
  void enqueue(ParticleStore& store, Transfer& transfer, NearNodes& near, double band,
               double longest_push);

  device::Buffer<Tool>& tools() { return tools_; }
  device::Buffer<std::int32_t>& node_tool() { return node_tool_; }
  device::Buffer<NodeShell>& node_shell() { return node_shell_; }

 private:
  device::Device& device_;
  device::KernelProgram program_;
  device::Kernel nodes_kernel_, particles_kernel_;
  /// The device may still be reading it.
  ToolShells now_;
  std::size_t near_particle_blocks_ = 0;
  // Written by the host.
  device::Buffer<ShellTriangle> triangles_;
  device::Buffer<ShellRim> rims_;
  /// contact_twist writes the twists, too.
  device::Buffer<Tool> tools_;
  /// CandidateRows of near active blocks.
  device::Buffer<std::int32_t> block_first_, block_triangles_;
  /// CandidateRows of near particle blocks.
  device::Buffer<std::int32_t> particle_first_, particle_triangles_;
  /// Indices of the near particle blocks.
  device::Buffer<std::int32_t> particle_block_list_;
  // Written by shell_nodes, BLOCK_NODES per near active block.
  /// Tool of the closest triangle, -1: none.
  device::Buffer<std::int32_t> node_tool_;
  /// Valid where there is a tool.
  device::Buffer<NodeShell> node_shell_;
};

}  // namespace navvy::soil
