// SPDX-License-Identifier: Apache-2.0
// Solves the contact of both node fields with tools: schedule of work-groups.
//
// In, Out: as in soil/lanes/contact.cl.
//
// Parallel: one work-group per near block, one node per work-item; contact_solve has one
// work-group. Repeatable: sums over contacts are added pairwise in a fixed order. Host:
// src/soil/tools/contact.cpp.
#include "soil/groups/group.h"
#include "soil/contact_node.h"
#include "soil/edge_node.h"
#include "soil/node.h"

__attribute__((reqd_work_group_size(BLOCK_NODES, 1, 1))) kernel void edge_nodes(
    EDGE_ARGS, global float4* restrict edge) {
  const int near = group_index(), me = get_local_id(0);
  edge[near_node(near, me)] = edge_node(near, me, EDGE_SAME);
}

// Lists the contacts of each near block, or only brings them up to date if `renew` is 0.
__attribute__((reqd_work_group_size(BLOCK_NODES, 1, 1))) kernel void contact_nodes(
    BLOCK_ARGS, NODE_ARGS, const int renew, global NodeContact* restrict contacts,
    global int* restrict counts) {
  local int taken[BLOCK_NODES];
  const int near = group_index(), me = get_local_id(0);
  const int3 key = keys[near_list[near]].xyz;
  global NodeContact* list = contacts + (size_t)near * BLOCK_CONTACTS;
  if (renew) {
    NodeContact found[2];
    bool is_contact[2];
    UNROLL
    for (int s = 0; s < 2; ++s) is_contact[s] = find_contact(found + s, s, near, me, NODE_SAME);
    taken[me] = (is_contact[0] ? 1 : 0) + (is_contact[1] ? 1 : 0);
    barrier(CLK_LOCAL_MEM_FENCE);
    // In ascending order of nodes.
    int at = 0;
    for (int i = 0; i < me; ++i) at += taken[i];
    if (me == BLOCK_NODES - 1) counts[near] = at + taken[me];
    UNROLL
    for (int s = 0; s < 2; ++s)
      if (is_contact[s]) list[at++] = found[s];
    barrier(CLK_GLOBAL_MEM_FENCE);
  }
  for (int c = me; c < counts[near]; c += BLOCK_NODES)
    update_contact(list + c, near, key, before0, before1, edge, tools, reach, dx);
}

// Number of work-items of contact_solve; BLOCK_NODES of them share a block.
#define SOLVERS 128

// Adds up the sums of all work-items of contact_solve into those of the first one.
static inline void add_up(local float* parts, const ContactSums* mine, int me) {
  // All words of the struct.
  const float* words = mine->wrench;
  for (int i = 0; i < CONTACT_SUM_WORDS; ++i) parts[SOLVERS * i + me] = words[i];
  barrier(CLK_LOCAL_MEM_FENCE);
  for (int left = SOLVERS / 2; left > 0; left /= 2) {
    if (me < left)
      for (int i = 0; i < CONTACT_SUM_WORDS; ++i)
        parts[SOLVERS * i + me] += parts[SOLVERS * i + me + left];
    barrier(CLK_LOCAL_MEM_FENCE);
  }
}

// Solves the twists of all tools that yield, one after another.
__attribute__((reqd_work_group_size(SOLVERS, 1, 1))) kernel void contact_solve(
    global Tool* restrict tools, const int tool_count, global const NodeContact* restrict contacts,
    global const int* restrict counts, const int blocks, const Reach reach,
    global int* restrict first) {
  local float parts[CONTACT_SUM_WORDS * SOLVERS];
  const int me = get_local_id(0);
  if (me == 0) {
    first[0] = 0;
    for (int near = 0; near < blocks; ++near) first[near + 1] = first[near] + counts[near];
  }
  for (int t = 0; t < tool_count; ++t) {
    // The same for all work-items: nothing changes the inverse mass.
    if (!yields(tools + t)) continue;
    for (int sweep = 0; sweep < CONTACT_SWEEPS; ++sweep) {
      ContactSums mine = NO_SUMS;
      for (int near = me / BLOCK_NODES; near < blocks; near += SOLVERS / BLOCK_NODES)
        for (int c = me % BLOCK_NODES; c < counts[near]; c += BLOCK_NODES) {
          global const NodeContact* contact = contacts + (size_t)near * BLOCK_CONTACTS + c;
          if (CONTACT_TOOL(contact->place) == t) add_sums(&mine, contact, tools, reach);
        }
      add_up(parts, &mine, me);
      if (me == 0) {
        ContactSums total;
        for (int i = 0; i < 6; ++i) total.wrench[i] = parts[SOLVERS * i];
        for (int i = 0; i < 21; ++i) total.stiffness[i] = parts[SOLVERS * (6 + i)];
        solve_twist(tools + t, &total);
      }
      // The next sweep reads the new twist.
      barrier(CLK_LOCAL_MEM_FENCE | CLK_GLOBAL_MEM_FENCE);
    }
  }
}

// Returns what particles get from field s of a node, with its mass per free volume beside ground
// and plate, or that of the step before if `renew` is 0. v: velocity and mass of the field; last:
// what particles got in the step before.
static inline float4 seen_node(float4 v, float4 last, int renew, int s, int i, int n,
                               global const BlockFloor* ground, global const int* split,
                               global const int* node_tool, global const NodeShell* shell,
                               global const Tool* tools) {
  const float z = (float)(n >> 4);
  const bool held = z <= ground->held[n & 15];
  if (!renew) return (float4)(held ? (float3)(0.0f) : v.xyz, last.w);
  const float4 below = z - vload4(n & 15, ground->around[0]);
  const float beside =
      (s == 0 ? 1.0f : -1.0f) * shell[i].distance - tools[max(node_tool[i], 0)].half_thickness;
  const float free_fraction = v.w == 0.0f     ? 1.0f
                              : split[i] == 0 ? free_fraction_above(below)
                                              : free_fraction_between(below, beside);
  return (float4)(held ? (float3)(0.0f) : v.xyz, v.w / free_fraction);
}

__attribute__((reqd_work_group_size(BLOCK_NODES, 1, 1))) kernel void contact_apply(
    global const int* restrict near_list, global const float4* restrict before0,
    global const float4* restrict before1, global const int* restrict split,
    global const int* restrict node_tool, global const NodeShell* restrict shell,
    global const Tool* restrict tools, global const NodeContact* restrict contacts,
    global const int* restrict first, global const BlockFloor* restrict floors, const Reach reach,
    const int renew, global ContactRecord* restrict records, global float4* restrict velocity0,
    global float4* restrict velocity1) {
  const int near = group_index(), me = get_local_id(0);
  const int block = near_list[near], i = near_node(near, me);
  global const BlockFloor* ground = floors + block;
  global float4* seen0 = velocity0 + (size_t)block * BLOCK_NODES + me;
  *seen0 = seen_node(before0[i], *seen0, renew, 0, i, me, ground, split, node_tool, shell, tools);
  velocity1[i] =
      seen_node(before1[i], velocity1[i], renew, 1, i, me, ground, split, node_tool, shell, tools);
  // Contacts overwrite velocities of nodes that other work-items wrote.
  barrier(CLK_GLOBAL_MEM_FENCE);
  for (int c = me; c < first[near + 1] - first[near]; c += BLOCK_NODES)
    records[first[near] + c] = apply_contact(contacts + (size_t)near * BLOCK_CONTACTS + c, near,
                                             block, ground, tools, reach, velocity0, velocity1);
}
