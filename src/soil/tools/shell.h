// SPDX-License-Identifier: Apache-2.0
// Positions of nodes and particles relative to the shells of tools, computed on the device.
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

/// Tools of one step in the form that the kernels read. Triangles are numbered consecutively over
/// all tools.
struct ToolShells {
  /// Triangles of all tools, tool by tool.
  std::vector<ShellTriangle> triangles;
  /// Free edges of all tools, tool by tool.
  std::vector<ShellRim> rims;
  /// One entry per registered tool.
  std::vector<Tool> tools;
};

/// List of candidate triangles for each of several blocks, in compressed rows: the candidates of
/// block r are triangles[first[r]] .. triangles[first[r + 1] - 1].
struct CandidateRows {
  /// `first`: one entry per block and a final end. `triangles`: triangle indices, ascending within
  /// each block.
  std::vector<std::int32_t> first, triangles;
};

/// Kernels of kernels/soil/*/shell.cl, with their data of the tools and their results for near
/// nodes: nodes of blocks that a tool's shell may touch (near blocks).
///
/// Result arrays have BLOCK_NODES entries per near block, in the order of NearNodes::list. The
/// kernels run only in the first step of a transfer, i.e. of a group of steps in which particles
/// keep their positions.
class ShellQuery {
 public:
  /// Builds the kernels with the constants `scheme`.
  explicit ShellQuery(device::Device& device, const SchemeConstants& scheme = kScheme);

  /// Uploads the triangles that may be near each near active block (`node_candidates`) and each
  /// near particle block (`particle_candidates`). `near_particle_blocks`: particle-block indices of
  /// the latter.
  void set_near(const CandidateRows& node_candidates, const CandidateRows& particle_candidates,
                const std::vector<std::int32_t>& near_particle_blocks);
  /// Uploads triangles, free edges and tools of the step without waiting. The contact solve later
  /// changes the twists of the tools on the device.
  void set_tools(ToolShells shells);
  /// Uploads new twists and origins of the same tools without waiting. Triangles and free edges
  /// stay as they are.
  void set_twists(std::vector<Tool> tools);
  /// Queues the kernel for near nodes: writes NearNodes::split, node_tool() and node_shell().
  /// `band`: distance from a plate within which nodes and particles have a side [cells].
  void enqueue_nodes(Transfer& transfer, NearNodes& near, double band);
  /// Queues the kernels for near nodes, as enqueue_nodes, and for particles: the latter writes
  /// sides and positions of the particles, and Report.push and Report.crossed of near blocks.
  /// `band`, `longest_push` [cells]: the scheme constants contact_band and contact_max_push.
  void enqueue(ParticleStore& store, Transfer& transfer, NearNodes& near, double band,
               double longest_push);

  /// Returns the tools on the device, by tool index.
  device::Buffer<Tool>& tools() { return tools_; }
  /// Returns the index of the tool closest to each near node, -1 if none is near.
  device::Buffer<std::int32_t>& node_tool() { return node_tool_; }
  /// Returns the position of each near node relative to the closest plate; valid only where
  /// node_tool() is not -1.
  device::Buffer<NodeShell>& node_shell() { return node_shell_; }

 private:
  /// Device that runs the kernels.
  device::Device& device_;
  /// Compiled program of both kernels.
  device::KernelProgram program_;
  /// Kernels: nodes_kernel_ for near nodes, particles_kernel_ for particles in near blocks.
  device::Kernel nodes_kernel_, particles_kernel_;
  /// Uploaded tools. Uploads do not wait, so the device may still be reading this memory.
  ToolShells now_;
  /// Number of near particle blocks: those that a tool's shell may touch in this transfer.
  std::size_t near_particle_blocks_ = 0;
  /// Triangles of all tools, written by the host.
  device::Buffer<ShellTriangle> triangles_;
  /// Free edges of all tools, written by the host.
  device::Buffer<ShellRim> rims_;
  /// Tools, written by the host. The kernel contact_solve changes their twists.
  device::Buffer<Tool> tools_;
  /// Candidate triangles of the near active blocks: block_first_ holds CandidateRows::first,
  /// block_triangles_ holds CandidateRows::triangles.
  device::Buffer<std::int32_t> block_first_, block_triangles_;
  /// Candidate triangles of the near particle blocks: particle_first_ holds CandidateRows::first,
  /// particle_triangles_ holds CandidateRows::triangles.
  device::Buffer<std::int32_t> particle_first_, particle_triangles_;
  /// Particle-block indices of the near particle blocks.
  device::Buffer<std::int32_t> particle_block_list_;
  /// Tool of the triangle closest to each near node, -1 if none is near (kernel shell_nodes).
  device::Buffer<std::int32_t> node_tool_;
  /// Position of each near node relative to that triangle; valid where node_tool_ is not -1 (kernel
  /// shell_nodes).
  device::Buffer<NodeShell> node_shell_;
};

}  // namespace navvy::soil
