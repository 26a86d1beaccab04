// SPDX-License-Identifier: Apache-2.0
// Solves the contact of both node fields with tools: schedule of work-groups.
//
// In, Out: as in soil/lanes/contact.cl.
//
// Parallel: one work-group per near block, one node per work-item. Repeatable: sums over nodes and
// blocks are added pairwise in a fixed order. Host: src/soil/tools/contact.cpp.
#include "soil/contact_node.h"
#include "soil/edge_node.h"

__attribute__((reqd_work_group_size(BLOCK_NODES, 1, 1))) kernel void edge_nodes(
    EDGE_ARGS, global float4* restrict edge) {
  const int near = get_group_id(0), me = get_local_id(0);
  edge[near_node(near, me)] = edge_node(near, me, EDGE_SAME);
}

// Computes the sums of one tool. Out: one ContactSums per near block.
__attribute__((reqd_work_group_size(BLOCK_NODES, 1, 1))) kernel void contact_sums(
    BLOCK_ARGS, NODE_ARGS, global ContactSums* restrict sums) {
  local float parts[CONTACT_SUM_WORDS * BLOCK_NODES];
  const int near = get_group_id(0), me = get_local_id(0);
  const int3 key = keys[near_list[near]].xyz;
  ContactSums mine = NO_SUMS;
  for (int s = 0; s < 2; ++s) add_sums(&mine, s, near, me, key, NODE_SAME);
  // All words of the struct.
  const float* words = mine.wrench;
  for (int i = 0; i < CONTACT_SUM_WORDS; ++i) parts[BLOCK_NODES * i + me] = words[i];
  barrier(CLK_LOCAL_MEM_FENCE);
  for (int left = BLOCK_NODES / 2; left > 0; left /= 2) {
    if (me < left)
      for (int i = 0; i < CONTACT_SUM_WORDS; ++i)
        parts[BLOCK_NODES * i + me] += parts[BLOCK_NODES * i + me + left];
    barrier(CLK_LOCAL_MEM_FENCE);
  }
  if (me < CONTACT_SUM_WORDS) ((global float*)(sums + near))[me] = parts[BLOCK_NODES * me];
}

// Solves one Newton iteration in one work-group: each work-item adds up one word over the blocks.
__attribute__((reqd_work_group_size(CONTACT_SUM_WORDS, 1, 1))) kernel void contact_twist(
    global Tool* restrict tools, const int tool, global const ContactSums* restrict sums,
    const int blocks) {
  local float parts[CONTACT_SUM_WORDS];
  const int me = get_local_id(0);
  float sum = 0.0f;
  for (int near = 0; near < blocks; ++near) sum += ((global const float*)(sums + near))[me];
  parts[me] = sum;
  barrier(CLK_LOCAL_MEM_FENCE);
  if (me > 0) return;
  ContactSums total;
  for (int i = 0; i < 6; ++i) total.wrench[i] = parts[i];
  for (int i = 0; i < 21; ++i) total.stiffness[i] = parts[6 + i];
  solve_twist(tools + tool, &total);
}

__attribute__((reqd_work_group_size(BLOCK_NODES, 1, 1))) kernel void contact_apply(
    BLOCK_ARGS, NODE_ARGS, global const BlockFloor* restrict floors, global int* restrict touched,
    global ContactRecord* restrict records, global float4* restrict velocity0,
    global float4* restrict velocity1) {
  local int changed;
  const int near = get_group_id(0), me = get_local_id(0);
  const int block = near_list[near], i = near_node(near, me);
  if (me == 0) changed = 0;
  barrier(CLK_LOCAL_MEM_FENCE);
  const NodeResult result = apply_contact(near, me, keys[block].xyz, floors + block, NODE_SAME);
  records[2 * i] = result.records[0];
  records[2 * i + 1] = result.records[1];
  velocity0[(size_t)block * BLOCK_NODES + me] = result.seen[0];
  velocity1[i] = result.seen[1];
  atomic_or(&changed, result.changed);
  barrier(CLK_LOCAL_MEM_FENCE);
  if (me == 0) touched[near] = changed;
}
