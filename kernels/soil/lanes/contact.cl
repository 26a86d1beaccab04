// SPDX-License-Identifier: Apache-2.0
// Contact of the two node fields with tools: kinematic, unilateral, Coulomb and adhesion; and the
// sums of the two-way solve.
//
// In:  fields per near node (v after gravity [m/s], m [kg]); shell data of shell.cl; surface per
// near node; tools.
//      only: tool whose nodes count, -1: all.
// One work-item per near block. Host: src/soil/tools/contact.cpp. Lengths of node data in cells,
// everything else SI. The tool's twist is about its frame's origin, axes of W.
#include "soil/contact_node.h"

// Out: sums per near block.
__attribute__((reqd_work_group_size(1, 1, 1))) kernel void contact_sums(BLOCK_ARGS, NODE_ARGS,
                                                                        global ContactSums* restrict sums) {
  const int near = get_global_id(0);
  const int3 key = keys[near_list[near]].xyz;
  ContactSums out = NO_SUMS;
  for (int n = 0; n < BLOCK_NODES; ++n)
    for (int s = 0; s < 2; ++s) add_sums(&out, s, near, n, key, NODE_SAME);
  sums[near] = out;
}

// One sweep of the two-way solve.
__attribute__((reqd_work_group_size(1, 1, 1))) kernel void contact_twist(global Tool* restrict tools, const int tool,
                                                                         global const ContactSums* restrict sums,
                                                                         const int blocks) {
  ContactSums total = NO_SUMS;
  for (int near = 0; near < blocks; ++near) {
    for (int i = 0; i < 6; ++i) total.wrench[i] += sums[near].wrench[i];
    for (int i = 0; i < 21; ++i) total.stiffness[i] += sums[near].stiffness[i];
  }
  solve_twist(tools + tool, &total);
}

// Applies the impulses of the final twist, then holds nodes at or below the resting ground. Out:
// velocity0 (per active block) and velocity1 (per near block) = what particles will feel, with
// masses per room (soil/node.h). For the host: touched[near] = 1 when any node of the block
// changed; records per node and field, valid in touched blocks.
__attribute__((reqd_work_group_size(1, 1, 1))) kernel void contact_apply(
    BLOCK_ARGS, NODE_ARGS, global const BlockFloor* restrict floors, global int* restrict touched,
    global ContactRecord* restrict records, global float4* restrict velocity0, global float4* restrict velocity1) {
  const int near = get_global_id(0);
  const int block = near_list[near];
  const int3 key = keys[block].xyz;
  int changed = 0;
  for (int n = 0; n < BLOCK_NODES; ++n) {
    const int i = near_node(near, n);
    const NodeResult result = apply_contact(near, n, key, floors + block, NODE_SAME);
    records[2 * i] = result.records[0];
    records[2 * i + 1] = result.records[1];
    velocity0[(size_t)block * BLOCK_NODES + n] = result.felt[0];
    velocity1[i] = result.felt[1];
    changed |= result.changed;
  }
  touched[near] = changed;
}
