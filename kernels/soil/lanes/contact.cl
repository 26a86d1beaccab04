// SPDX-License-Identifier: Apache-2.0
// Solves the contact of both node fields with tools: kinematic, unilateral, Coulomb friction and
// adhesion, together with the twists of tools that yield.
//
// In: fields per near node (v after gravity [m/s], m [kg]); shell data of shell.cl; surface per
// near node; tools. Lengths of node data are in cells, everything else is SI. A tool's twist is
// about the origin of its frame, along the axes of W.
//
// Parallel: one work-item per near block, except contact_solve, which has one work-item: a step has
// some hundred contacts. Repeatable: fixed order of sums. Host: src/soil/tools/contact.cpp.
#include "soil/lanes/contact_sums.h"
#include "soil/lanes/lanes.h"

// Takes the sums of contact_sums.h.
#include "soil/contact_node.h"
#include "soil/edge_node.h"
#include "soil/node.h"

KERNEL_SHARE(kernel_share16, real)

// Finds the resistance of soil on the edges of plates. Out: float4 per near node: outward direction
// of the plate, largest force of the edge [Pa cell faces].
__attribute__((reqd_work_group_size(1, 1, 1))) kernel void edge_nodes(
    EDGE_ARGS, global float4* restrict edge) {
  const int near = group_index();
  for (int n = 0; n < BLOCK_NODES; ++n) edge[near_node(near, n)] = edge_node(near, n, EDGE_SAME);
}

// Lists the contacts of each near block, or only brings them up to date if `renew` is 0, in a later
// step of a transfer. Out: contacts, in ascending order of nodes, and their number, per near block.
__attribute__((reqd_work_group_size(1, 1, 1))) kernel void contact_nodes(
    BLOCK_ARGS, NODE_ARGS, const int renew, global NodeContact* restrict contacts,
    global int* restrict counts) {
  const int near = group_index();
  const int3 key = keys[near_list[near]].xyz;
  global NodeContact* list = contacts + (size_t)near * BLOCK_CONTACTS;
  int count = renew ? 0 : counts[near];
  for (int row = 0; row < BLOCK_NODES / 4 && renew; ++row) {
    const int first = near_node(near, 4 * row);
    // Most rows have no soil, or are neither beside a plate nor ahead of an edge.
    const float4 front = vload16(0, (global const float*)(before0 + first)).s37bf;
    const float4 back = vload16(0, (global const float*)(before1 + first)).s37bf;
    const float16 ahead = vload16(0, (global const float*)(edge + first));
    const int4 at_edge = ahead.s048c != 0.0f || ahead.s159d != 0.0f || ahead.s26ae != 0.0f;
    const int4 splits = vload4(0, split + first);
    const int4 full = front > MASS_QUANTUM || back > MASS_QUANTUM;
    const int4 maybe = full && (splits != 0 || at_edge);
    if (((maybe.x | maybe.y) | (maybe.z | maybe.w)) == 0) continue;
    for (int n = 4 * row; n < 4 * row + 4; ++n)
      for (int s = 0; s < 2; ++s) {
        NodeContact found;
        if (find_contact(&found, s, near, n, NODE_SAME)) list[count++] = found;
      }
  }
  for (int c = 0; c < count; ++c)
    update_contact(list + c, near, key, before0, before1, edge, tools, reach, dx);
  counts[near] = count;
}

// Solves the twists of all tools that yield, by Newton's method. Out: twists; first: sums of the
// numbers of contacts of the blocks before each near block, and of all.
__attribute__((reqd_work_group_size(1, 1, 1))) kernel void contact_solve(
    global Tool* restrict tools, const int tool_count, global const NodeContact* restrict contacts,
    global const int* restrict counts, const int blocks, const Reach reach,
    global int* restrict first) {
  first[0] = 0;
  for (int near = 0; near < blocks; ++near) first[near + 1] = first[near] + counts[near];
  if (first[blocks] == 0) return;
  for (int t = 0; t < tool_count; ++t)
    for (int sweep = 0; sweep < CONTACT_SWEEPS && yields(tools + t); ++sweep) {
      LaneSums all = {(float8)(0.0f), (float16)(0.0f), (float4)(0.0f), 0.0f};
      for (int near = 0; near < blocks; ++near) {
        LaneSums sums = {(float8)(0.0f), (float16)(0.0f), (float4)(0.0f), 0.0f};
        for (int c = 0; c < counts[near]; ++c) {
          global const NodeContact* contact = contacts + (size_t)near * BLOCK_CONTACTS + c;
          if (CONTACT_TOOL(contact->place) == t) add_sums(&sums, contact, tools, reach);
        }
        all.wrench += sums.wrench;
        all.rows += sums.rows;
        all.rest += sums.rest;
        all.last += sums.last;
      }
      ContactSums total;
      vstore3(all.wrench.s012, 0, total.wrench);
      vstore3(all.wrench.s345, 1, total.wrench);
      vstore16(all.rows, 0, total.stiffness);
      vstore4(all.rest, 4, total.stiffness);
      total.stiffness[20] = all.last;
      solve_twist(tools + t, &total);
    }
}

// Returns the masses of four nodes divided by their free fractions (soil/node.h). above: true where
// no ground is in the kernel of the node; ground: fraction above the ground; beside: fraction
// beside the plate; split: 0 for a node without a plate.
static inline float4 per_free_volume(float4 m, int4 above, float4 ground, float4 beside,
                                     int4 split) {
  const float4 least = SCHEME(min_free_fraction);
  const float4 open =
      above ? (float4)(1.0f) : fmax(ground * mean_of(kernel_share((float4)(1.5f))), least);
  const float4 fraction = split == 0 ? open : fmax(ground * beside, least);
  return m == 0.0f ? m : m / fraction;
}

// Returns the means over the four columns around each of four nodes.
INLINED float4 means(float16 t) {
  const float8 pairs = t.even + t.odd;
  return 0.25f * (pairs.even + pairs.odd);
}

// Returns what particles get from a row of four nodes: velocities, 0 where the ground holds the
// node, and masses per free volume.
INLINED float16 seen_row(float16 v, int4 held, float4 m) {
  const int16 lanes = (int16)(held.xxxx, held.yyyy, held.zzzz, held.wwww);
  const float16 moves = lanes ? (float16)(0.0f) : v;
  return (float16)(moves.s012, m.x, moves.s456, m.y, moves.s89a, m.z, moves.scde, m.w);
}

// Applies the impulses of the final twists, then holds nodes at or below the resting ground. renew:
// 0 if the masses per free volume are those of the step before.
//
// Out: velocity0 (per active block) and velocity1 (per near block): what particles see, with mass
// per free volume (soil/node.h). For the host: records of all contacts, block by block.
__attribute__((reqd_work_group_size(1, 1, 1))) kernel void contact_apply(
    global const int* restrict near_list, global const float4* restrict before0,
    global const float4* restrict before1, global const int* restrict split,
    global const int* restrict node_tool, global const NodeShell* restrict shell,
    global const Tool* restrict tools, global const NodeContact* restrict contacts,
    global const int* restrict first, global const BlockFloor* restrict floors, const Reach reach,
    const int renew, global ContactRecord* restrict records, global float4* restrict velocity0,
    global float4* restrict velocity1) {
  const int near = group_index();
  const int block = near_list[near];
  global const BlockFloor* ground = floors + block;
  for (int row = 0; row < BLOCK_NODES / 4; ++row) {
    const int i = near_node(near, 4 * row);
    const float16 front = vload16(0, (global const float*)(before0 + i));
    const float16 back = vload16(0, (global const float*)(before1 + i));
    global float* out0 = (global float*)(velocity0 + (size_t)block * BLOCK_NODES + 4 * row);
    global float* out1 = (global float*)(velocity1 + i);
    if (!some(front != 0.0f | back != 0.0f)) {
      PUT16((float16)(0.0f), out0);
      PUT16((float16)(0.0f), out1);
      continue;
    }
    const float z = (float)(row >> 2);
    const int4 held = z <= vload4(row & 3, ground->held);
    if (!renew) {
      PUT16(seen_row(front, held, vload16(0, out0).s37bf), out0);
      PUT16(seen_row(back, held, vload16(0, out1).s37bf), out1);
      continue;
    }
    const float16 below = z - vload16(row & 3, ground->around[0]);
    const int16 clear = below >= 1.5f;
    const int8 pairs = clear.even & clear.odd;
    const int4 above = pairs.even & pairs.odd;
    const float4 share = means(kernel_share16(below));
    const int4 splits = vload4(0, split + i);
    float16 beside = 1.5f;
    if (((splits.x | splits.y) | (splits.z | splits.w)) != 0) {
      float off[16];
      for (int k = 0; k < 4; ++k) {
        const float half_thickness = tools[max(node_tool[i + k], 0)].half_thickness;
        off[k] = shell[i + k].distance - half_thickness;
        off[4 + k] = -shell[i + k].distance - half_thickness;
        off[8 + k] = off[12 + k] = 1.5f;
      }
      beside = kernel_share16(vload16(0, off));
    }
    PUT16(seen_row(front, held, per_free_volume(front.s37bf, above, share, beside.lo.lo, splits)),
          out0);
    PUT16(seen_row(back, held, per_free_volume(back.s37bf, above, share, beside.lo.hi, splits)),
          out1);
  }
  for (int c = 0; c < first[near + 1] - first[near]; ++c)
    records[first[near] + c] = apply_contact(contacts + (size_t)near * BLOCK_CONTACTS + c, near,
                                             block, ground, tools, reach, velocity0, velocity1);
}
