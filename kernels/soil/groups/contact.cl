// SPDX-License-Identifier: Apache-2.0
// Contact of the two node fields with tools: schedule of work-groups.
//
// In, Out: as in soil/contact.cl. One work-group per near block, one node per work-item; sums over nodes and blocks are
// halved pair by pair in a fixed order. Host: src/soil/tools/contact.cpp.
#include "soil/contact_node.h"

// Out: CONTACT_SUMS per near block.
__attribute__((reqd_work_group_size(BLOCK_NODES, 1, 1))) kernel void contact_sums(BLOCK_ARGS, NODE_ARGS,
                                                                                  global float* restrict sums) {
  local float parts[CONTACT_SUMS * BLOCK_NODES];
  const int slot = get_group_id(0), me = get_local_id(0);
  const int3 key = keys[near_list[slot]].xyz;
  float out[CONTACT_SUMS];
  for (int i = 0; i < CONTACT_SUMS; ++i) out[i] = 0.0f;
  for (int s = 0; s < 2; ++s) add_sums(out, s, slot, me, key, NODE_SAME);
  for (int i = 0; i < CONTACT_SUMS; ++i) parts[BLOCK_NODES * i + me] = out[i];
  barrier(CLK_LOCAL_MEM_FENCE);
  for (int left = BLOCK_NODES / 2; left > 0; left /= 2) {
    if (me < left)
      for (int i = 0; i < CONTACT_SUMS; ++i) parts[BLOCK_NODES * i + me] += parts[BLOCK_NODES * i + me + left];
    barrier(CLK_LOCAL_MEM_FENCE);
  }
  if (me < CONTACT_SUMS) sums[CONTACT_SUMS * slot + me] = parts[BLOCK_NODES * me];
}

// One sweep of the two-way solve by one work-group: a work-item adds up one sum over the blocks.
__attribute__((reqd_work_group_size(CONTACT_SUMS, 1, 1))) kernel void contact_twist(global float4* restrict frame,
                                                                                    const int first_tool,
                                                                                    const int tool,
                                                                                    global const float* restrict sums,
                                                                                    const int slots) {
  local float parts[CONTACT_SUMS];
  const int me = get_local_id(0);
  float sum = 0.0f;
  for (int slot = 0; slot < slots; ++slot) sum += sums[CONTACT_SUMS * slot + me];
  parts[me] = sum;
  barrier(CLK_LOCAL_MEM_FENCE);
  if (me > 0) return;
  float total[CONTACT_SUMS];
  for (int i = 0; i < CONTACT_SUMS; ++i) total[i] = parts[i];
  solve_twist((global float*)(frame + first_tool) + TOOL_WORDS * tool, total);
}

__attribute__((reqd_work_group_size(BLOCK_NODES, 1, 1))) kernel void contact_apply(
    BLOCK_ARGS, NODE_ARGS, global const float* restrict floor_height, global int* restrict touched,
    global float8* restrict books, global float4* restrict velocity0, global float4* restrict velocity1) {
  local int changed;
  const int slot = get_group_id(0), me = get_local_id(0);
  const int block = near_list[slot], i = slot * BLOCK_NODES + me;
  if (me == 0) changed = 0;
  barrier(CLK_LOCAL_MEM_FENCE);
  const Result result = apply_contact(slot, me, keys[block].xyz, floor_height + FLOOR_WORDS * block, NODE_SAME);
  books[2 * i] = result.books[0];
  books[2 * i + 1] = result.books[1];
  velocity0[(size_t)block * BLOCK_NODES + me] = result.felt[0];
  velocity1[i] = result.felt[1];
  atomic_or(&changed, result.changed);
  barrier(CLK_LOCAL_MEM_FENCE);
  if (me == 0) touched[slot] = changed;
}
