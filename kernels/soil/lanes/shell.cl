// SPDX-License-Identifier: Apache-2.0
// Finds signed distance, normal and side of nodes and particles near shells, and keeps particles on
// their side.
//
// In: triangles, rims, tools (tool.h); first / list: candidate triangles per near block (compressed
// rows); band: distance within which particles have a side [cells].
//
// Parallel: one work-item per near block, nothing shared. Repeatable: fixed order. Host:
// src/soil/tools/shell.cpp.
#include "soil/lanes/lanes.h"
#include "soil/shell_side.h"

// Finds the closest point for `packs` packs of a block's particles from `slot` on. What a triangle
// needs is computed once for all of them.
#define PACKS 8
static inline void query_packs(global const float* state, int capacity, int slot, int packs,
                               int3 key, global const ShellTriangle* triangles,
                               global const Tool* tools, global const int* list, int begin, int end,
                               float far, Closest* best) {
  for (int p = 0; p < packs; ++p) {
    best[p].distance2 = INFINITY;
    best[p].x = best[p].y = best[p].z = 0.0f;
    best[p].feature = -1;
  }
  for (int i = begin; i < end; ++i) {
    const float3 shift = convert_float3(4 * (key - window_of(tools, triangles[list[i]].tool)));
    for (int p = 0; p < packs; ++p, slot += NAVVY_LANES)
      closest_triangle(LOAD(FIELD_X) + shift.x, LOAD(FIELD_X + 1) + shift.y,
                       LOAD(FIELD_X + 2) + shift.z, triangles, list[i], far, best + p);
    slot -= NAVVY_LANES * packs;
  }
}

// Classifies near nodes. Out, per node: split (0 none, 1 in front, 2 behind), tool, and NodeShell.
__attribute__((reqd_work_group_size(1, 1, 1))) kernel void shell_nodes(
    global const int* restrict near_list, global const int4* restrict keys,
    global const ShellTriangle* restrict triangles, global const ShellRim* restrict rims,
    const int rim_count, global const Tool* restrict tools, global const int* restrict first,
    global const int* restrict list, const float band, global int* restrict node_split,
    global int* restrict node_tool, global NodeShell* restrict node_shell) {
  const int near = group_index();
  const int3 key = keys[near_list[near]].xyz;
  const real step_x = (real)(0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3);
  const real step_y = (real)(0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 2, 2, 3, 3, 3, 3);
  for (int layer = 0; layer < 4; ++layer) {
    Closest best;
    const real step_z = (float)layer;
    query(step_x, step_y, step_z, key, triangles, tools, list, first[near], first[near + 1], band,
          &best);
    float d2[16], cx[16], cy[16], cz[16], inset[16];
    int feature[16], tool_of[16];
    vstore16(best.feature, 0, feature);
    for (int l = 0; l < 16; ++l) tool_of[l] = feature[l] < 0 ? -1 : triangles[feature[l] >> 3].tool;
    const int16 tool_lanes = vload16(0, tool_of);
    real inset2 = INFINITY;
    if (some(best.distance2 < band * band))
      inset2 = inset2_of(best.x, best.y, best.z, tool_lanes, rims, rim_count);
    vstore16(best.distance2, 0, d2);
    vstore16(best.x, 0, cx);
    vstore16(best.y, 0, cy);
    vstore16(best.z, 0, cz);
    vstore16(sqrt(inset2), 0, inset);
    for (int l = 0; l < 16; ++l) {
      const int node = near * BLOCK_NODES + 16 * layer + l;
      node_split[node] = 0;
      node_tool[node] = tool_of[l];
      if (tool_of[l] < 0) continue;
      const float3 here =
          convert_float3(4 * (key - window_of(tools, tool_of[l])) + (int3)(l & 3, l >> 2, layer));
      float phi;
      float3 normal;
      bool rim;
      resolve(triangles, feature[l], here - (float3)(cx[l], cy[l], cz[l]), d2[l], &phi, &normal,
              &rim);
      node_split[node] = split_of(rim, phi, band);
      node_shell[node] = node_shell_of(normal, phi, inset[l]);
    }
  }
}

// Updates the side of particles and moves those that sank into a plate back to its surface
// (position only). Out: Report.push and Report.crossed of the near blocks.
__attribute__((reqd_work_group_size(1, 1, 1))) kernel void shell_particles(
    global float* restrict state, const int capacity, global const int* restrict near_list,
    global const ParticleBlock* restrict particle_blocks, global const int4* restrict keys,
    global const ShellTriangle* restrict triangles, global const Tool* restrict tools,
    global const int* restrict first, global const int* restrict list, const float band,
    const float longest_push, global Report* restrict report) {
  const int near = group_index();
  const int particle_block = near_list[near];
  const int3 key = keys[particle_block].xyz;
  float far_push = 0.0f;
  int crossings = 0;
  const int end = particle_blocks[particle_block].start + particle_blocks[particle_block].count;
  Closest found[PACKS];
  int pack = PACKS;
  for (int slot = particle_blocks[particle_block].start; slot < end; slot += 16, ++pack) {
    const int count = min(16, end - slot);
    if (pack == PACKS) {
      query_packs(state, capacity, slot, min(PACKS, (end - slot + 15) / 16), key, triangles, tools,
                  list, first[near], first[near + 1], band + 1.0f, found);
      pack = 0;
    }
    const Closest best = found[pack];
    const real x = LOAD(FIELD_X), y = LOAD(FIELD_X + 1), z = LOAD(FIELD_X + 2);
    // Outside the band, and not inside it before: the particle has no side.
    const int16 tags = as_int16(LOAD(FIELD_TAG));
    const int16 near_shell = best.distance2 < band * band | tags >> 16 != 0;
    if (!some(near_shell)) continue;
    float d2[16], cx[16], cy[16], cz[16], px[16], py[16], pz[16];
    int feature[16], tag[16], concerned[16];
    vstore16(near_shell, 0, concerned);
    vstore16(best.feature, 0, feature);
    vstore16(best.distance2, 0, d2);
    vstore16(best.x, 0, cx);
    vstore16(best.y, 0, cy);
    vstore16(best.z, 0, cz);
    vstore16(x, 0, px);
    vstore16(y, 0, py);
    vstore16(z, 0, pz);
    vstore16(tags, 0, tag);
    for (int l = 0; l < count; ++l) {
      if (!concerned[l]) continue;
      const SideResult result =
          enforce_side((float3)(px[l], py[l], pz[l]), tag[l] >> 16, key, feature[l], d2[l],
                       (float3)(cx[l], cy[l], cz[l]), band, longest_push, triangles, tools);
      px[l] = result.x.x;
      py[l] = result.x.y;
      pz[l] = result.x.z;
      far_push = fmax(far_push, result.push);
      crossings += result.crossed;
      tag[l] = (tag[l] & 0xffff) | (result.side << 16);
    }
    STORE(FIELD_X, vload16(0, px));
    STORE(FIELD_X + 1, vload16(0, py));
    STORE(FIELD_X + 2, vload16(0, pz));
    STORE(FIELD_TAG, as_float16(vload16(0, tag)));
  }
  report[particle_block].push = far_push;
  report[particle_block].crossed = crossings;
}
