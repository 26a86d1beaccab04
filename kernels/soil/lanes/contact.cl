// SPDX-License-Identifier: Apache-2.0
// Contact of the two node fields with tools: fractional, unilateral, Coulomb and adhesion; and the sums of
// the two-way solve.
//
// In:  fields per near node (v after gravity [m/s], m [kg]); shell data of shell.cl; surface per near node (tan
//      delta, adhesion [Pa], 1 / bank density, 0); tools: TOOL_WORDS floats each.
// One work-item per near block. Host: src/soil/tools/contact.cpp.
// Lengths of node data in cells, everything else SI. The tool's twist is about its frame's origin, axes of W.
#include "soil/contact_node.h"

// Out: CONTACT_SUMS per near block, see add_sums.
__attribute__((reqd_work_group_size(1, 1, 1))) kernel void contact_sums(BLOCK_ARGS, NODE_ARGS,
                                                                        global float* restrict sums) {
  const int slot = get_global_id(0);
  const int3 key = keys[near_list[slot]].xyz;
  float out[CONTACT_SUMS];
  for (int i = 0; i < CONTACT_SUMS; ++i) out[i] = 0.0f;
  for (int n = 0; n < BLOCK_NODES; ++n)
    for (int s = 0; s < 2; ++s) add_sums(out, s, slot, n, key, NODE_SAME);
  for (int i = 0; i < CONTACT_SUMS; ++i) sums[CONTACT_SUMS * slot + i] = out[i];
}

// One sweep of the two-way solve.
__attribute__((reqd_work_group_size(1, 1, 1))) kernel void contact_twist(global float4* restrict frame,
                                                                         const int first_tool, const int tool,
                                                                         global const float* restrict sums,
                                                                         const int slots) {
  float total[CONTACT_SUMS];
  for (int i = 0; i < CONTACT_SUMS; ++i) total[i] = 0.0f;
  for (int slot = 0; slot < slots; ++slot)
    for (int i = 0; i < CONTACT_SUMS; ++i) total[i] += sums[CONTACT_SUMS * slot + i];
  solve_twist((global float*)(frame + first_tool) + TOOL_WORDS * tool, total);
}

// Applies the impulses of the final twist, then holds nodes at or below the resting ground.
// Out: velocity0 (per active block) and velocity1 (per near block) = what particles will feel, with masses per room
// (room.h). For the books: touched[slot] = 1 when any node changed; books per node and field float8 (v before, m, v
// after contact and before the floor, normal impulse), valid in touched blocks.
__attribute__((reqd_work_group_size(1, 1, 1))) kernel void contact_apply(
    BLOCK_ARGS, NODE_ARGS, global const float* restrict floor_height, global int* restrict touched,
    global float8* restrict books, global float4* restrict velocity0, global float4* restrict velocity1) {
  const int slot = get_global_id(0);
  const int block = near_list[slot];
  const int3 key = keys[block].xyz;
  int changed = 0;
  for (int n = 0; n < BLOCK_NODES; ++n) {
    const int i = slot * BLOCK_NODES + n;
    const Result result = apply_contact(slot, n, key, floor_height + FLOOR_WORDS * block, NODE_SAME);
    books[2 * i] = result.books[0];
    books[2 * i + 1] = result.books[1];
    velocity0[(size_t)block * BLOCK_NODES + n] = result.felt[0];
    velocity1[i] = result.felt[1];
    changed |= result.changed;
  }
  touched[slot] = changed;
}
