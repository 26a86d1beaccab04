// SPDX-License-Identifier: Apache-2.0
// Solves the contact of both node fields with tools: kinematic, unilateral, Coulomb friction and
// adhesion; and computes the sums of the two-way solve.
//
// In: fields per near node (v after gravity [m/s], m [kg]); shell data of shell.cl; surface per
// near node; tools; only = tool whose nodes count, -1: all. Lengths of node data are in cells,
// everything else is SI. A tool's twist is about the origin of its frame, along the axes of W.
//
// Parallel: one work-item per near block. Repeatable: fixed order of sums. Host:
// src/soil/tools/contact.cpp.
#include "soil/contact_node.h"
#include "soil/edge_node.h"

// Finds the resistance of soil on the edges of plates. Out: float4 per near node: outward direction
// of the plate, largest force of the edge [Pa cell faces].
__attribute__((reqd_work_group_size(1, 1, 1))) kernel void edge_nodes(
    EDGE_ARGS, global float4* restrict edge) {
  const int near = get_global_id(0);
  for (int n = 0; n < BLOCK_NODES; ++n)
    edge[near_node(near, n)] = edge_node(near, n, EDGE_SAME);
}

// Computes the sums of one tool. Out: one ContactSums per near block.
__attribute__((reqd_work_group_size(1, 1, 1))) kernel void contact_sums(
    BLOCK_ARGS, NODE_ARGS, global ContactSums* restrict sums) {
  const int near = get_global_id(0);
  const int3 key = keys[near_list[near]].xyz;
  ContactSums out = NO_SUMS;
  for (int n = 0; n < BLOCK_NODES; ++n)
    for (int s = 0; s < 2; ++s) add_sums(&out, s, near, n, key, NODE_SAME);
  sums[near] = out;
}

// Solves one Newton iteration for the twist of one tool. Out: its twist.
__attribute__((reqd_work_group_size(1, 1, 1))) kernel void contact_twist(
    global Tool* restrict tools, const int tool, global const ContactSums* restrict sums,
    const int blocks) {
  ContactSums total = NO_SUMS;
  for (int near = 0; near < blocks; ++near) {
    for (int i = 0; i < 6; ++i) total.wrench[i] += sums[near].wrench[i];
    for (int i = 0; i < 21; ++i) total.stiffness[i] += sums[near].stiffness[i];
  }
  solve_twist(tools + tool, &total);
}

// Applies the impulses of the final twists, then holds nodes at or below the resting ground.
//
// Out: velocity0 (per active block) and velocity1 (per near block): what particles see, with mass
// per free volume (soil/node.h). For the host: touched[near] = 1 when any node of the block
// changed; records per node and field, valid in touched blocks.
__attribute__((reqd_work_group_size(1, 1, 1))) kernel void contact_apply(
    BLOCK_ARGS, NODE_ARGS, global const BlockFloor* restrict floors, global int* restrict touched,
    global ContactRecord* restrict records, global float4* restrict velocity0,
    global float4* restrict velocity1) {
  const int near = get_global_id(0);
  const int block = near_list[near];
  const int3 key = keys[block].xyz;
  int changed = 0;
  for (int n = 0; n < BLOCK_NODES; ++n) {
    const int i = near_node(near, n);
    const NodeResult result = apply_contact(near, n, key, floors + block, NODE_SAME);
    records[2 * i] = result.records[0];
    records[2 * i + 1] = result.records[1];
    velocity0[(size_t)block * BLOCK_NODES + n] = result.seen[0];
    velocity1[i] = result.seen[1];
    changed |= result.changed;
  }
  touched[near] = changed;
}
