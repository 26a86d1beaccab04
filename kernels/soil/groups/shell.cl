// SPDX-License-Identifier: Apache-2.0
// Finds signed distance, normal and side of nodes and particles near shells: schedule of
// work-groups.
//
// In, Out: as in soil/lanes/shell.cl.
//
// Parallel: one work-group per near block; a work-item is a node, or takes one particle after the
// other. Repeatable: the
// values of a block are found by integer atomics, which do not depend on order. Host:
// src/soil/tools/shell.cpp.
#include "soil/groups/group.h"
#include "soil/shell_side.h"

// A block near a shell has some hundred particles. On an H100 256 work-items took 16 us for them,
// 64 took 33 us.
#define MEMBERS 256

// Classifies near nodes. Out, per node: split (0 none, 1 in front, 2 behind), tool, and NodeShell.
__attribute__((reqd_work_group_size(BLOCK_NODES, 1, 1))) kernel void shell_nodes(
    global const int* restrict near_list, global const int4* restrict keys,
    global const ShellTriangle* restrict triangles, global const ShellRim* restrict rims,
    const int rim_count, global const Tool* restrict tools, global const int* restrict first,
    global const int* restrict list, const float band, global int* restrict node_split,
    global int* restrict node_tool, global NodeShell* restrict node_shell) {
  const int near = group_index(), me = get_local_id(0);
  const int node = near * BLOCK_NODES + me;
  const int3 key = keys[near_list[near]].xyz, in_block = (int3)(me & 3, (me >> 2) & 3, me >> 4);
  Closest best;
  query((float)in_block.x, (float)in_block.y, (float)in_block.z, key, triangles, tools, list,
        first[near], first[near + 1], band, &best);
  node_split[node] = 0;
  node_tool[node] = -1;
  if (best.feature < 0) return;
  const int tool = triangles[best.feature >> 3].tool;
  const float inset2 = inset2_of(best.x, best.y, best.z, tool, rims, rim_count);
  const float3 here = convert_float3(4 * (key - window_of(tools, tool)) + in_block);
  float phi;
  float3 normal;
  bool rim;
  resolve(triangles, best.feature, here - (float3)(best.x, best.y, best.z), best.distance2, &phi,
          &normal, &rim);
  node_tool[node] = tool;
  node_split[node] = split_of(rim, phi, band);
  node_shell[node] = node_shell_of(normal, phi, sqrt(inset2));
}

// Updates side and position of the particles. Out: Report.push and Report.crossed of the near
// blocks.
__attribute__((reqd_work_group_size(MEMBERS, 1, 1))) kernel void shell_particles(
    global float* restrict state, const int capacity, global const int* restrict near_list,
    global const ParticleBlock* restrict particle_blocks, global const int4* restrict keys,
    global const ShellTriangle* restrict triangles, global const Tool* restrict tools,
    global const int* restrict first, global const int* restrict list, const float band,
    const float longest_push, global Report* restrict report) {
  local int push, crossings;
  const int near = group_index(), me = get_local_id(0);
  const int particle_block = near_list[near];
  const int3 key = keys[particle_block].xyz;
  if (me == 0) push = crossings = 0;
  barrier(CLK_LOCAL_MEM_FENCE);
  for (int slot = particle_blocks[particle_block].start + me;
       slot < particle_blocks[particle_block].start + particle_blocks[particle_block].count;
       slot += MEMBERS) {
    const float3 x = (float3)(LOAD(FIELD_X), LOAD(FIELD_X + 1), LOAD(FIELD_X + 2));
    const int tag = as_int(LOAD(FIELD_TAG));
    Closest best;
    query(x.x, x.y, x.z, key, triangles, tools, list, first[near], first[near + 1], band + 1.0f,
          &best);
    // Outside the band, and not inside it before: the particle has no side.
    if (!(best.distance2 < band * band) && tag >> 16 == 0) continue;
    const SideResult result =
        enforce_side(x, tag >> 16, key, best.feature, best.distance2,
                     (float3)(best.x, best.y, best.z), band, longest_push, triangles, tools);
    STORE(FIELD_X, result.x.x);
    STORE(FIELD_X + 1, result.x.y);
    STORE(FIELD_X + 2, result.x.z);
    STORE(FIELD_TAG, as_float((tag & 0xffff) | (result.side << 16)));
    atomic_max_nonnegative(&push, result.push);
    if (result.crossed) atomic_inc(&crossings);
  }
  barrier(CLK_LOCAL_MEM_FENCE);
  if (me > 0) return;
  report[particle_block].push = as_float(push);
  report[particle_block].crossed = crossings;
}
