// SPDX-License-Identifier: Apache-2.0
#include "soil/tools/shell.h"

#include <utility>

#include "soil/particles/buffers.h"
#include "soil/particles/schedule.h"
#include "soil/scheme.h"

namespace navvy::soil {

ShellQuery::ShellQuery(device::Device& device, const SchemeConstants& scheme)
    : device_(device),
      program_(device, kernel_path(device, "shell"), scheme_options(scheme)),
      nodes_kernel_(program_, "shell_nodes"),
      particles_kernel_(program_, "shell_particles") {}

// There are as many rows as near blocks and near particle blocks, and one more entry that ends the
// last.
void ShellQuery::set_near(const CandidateRows& node_candidates,
                          const CandidateRows& particle_candidates,
                          const std::vector<std::int32_t>& near_particle_blocks) {
  near_particle_blocks_ = near_particle_blocks.size();
  upload(device_, block_first_, node_candidates.first);
  upload(device_, block_triangles_, node_candidates.triangles);
  upload(device_, particle_first_, particle_candidates.first);
  upload(device_, particle_triangles_, particle_candidates.triangles);
  upload(device_, particle_block_list_, near_particle_blocks);
  const std::size_t nodes = (node_candidates.first.size() - 1) * BLOCK_NODES;
  ensure(device_, node_tool_, nodes);
  ensure(device_, node_shell_, nodes);
}

void ShellQuery::set_tools(ToolShells shells) {
  // The previous step has been waited for: the old values are no longer read.
  now_ = std::move(shells);
  const auto send = [&](auto& buffer, const auto& values) {
    ensure(device_, buffer, values.size());
    buffer.write_later(values);
  };
  send(triangles_, now_.triangles);
  send(rims_, now_.rims);
  send(tools_, now_.tools);
}

void ShellQuery::set_twists(std::vector<Tool> tools) {
  now_.tools = std::move(tools);
  ensure(device_, tools_, now_.tools.size());
  tools_.write_later(now_.tools);
}

void ShellQuery::enqueue_nodes(Transfer& transfer, NearNodes& near, double band) {
  nodes_kernel_
      .args(near.list, transfer.active_keys(), triangles_, rims_,
            static_cast<int>(now_.rims.size()), tools_, block_first_, block_triangles_,
            static_cast<float>(band), near.split, node_tool_, node_shell_)
      .enqueue_groups(static_cast<std::size_t>(near.count));
}

void ShellQuery::enqueue(ParticleStore& store, Transfer& transfer, NearNodes& near, double band,
                         double longest_push) {
  // Neither kernel reads what the other writes; both use the poses of this step.
  enqueue_nodes(transfer, near, band);
  // Particles may be near a shell although no node of their own block is.
  particles_kernel_
      .args(store.state(), store.capacity(), particle_block_list_, store.particle_blocks_buffer(),
            store.block_keys(), triangles_, tools_, particle_first_, particle_triangles_,
            static_cast<float>(band), static_cast<float>(longest_push), transfer.report())
      .enqueue_groups(near_particle_blocks_);
}

}  // namespace navvy::soil
