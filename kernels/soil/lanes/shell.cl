// SPDX-License-Identifier: Apache-2.0
// Where nodes and particles lie relative to the shells: signed distance, normal, side; keeps particles on their side.
//
// In:  frame (layout.h): triangles, free edges, tools; first / list: candidate triangles per near block (compressed
//      rows). Band [cells]: how far a side reaches.
// One work-item per near block, nothing shared. Host: src/soil/tools/contact.cpp.
#include "soil/lanes/lanes.h"
#include "soil/shell_side.h"

// The same for `packs` packs of a home's particles from slot `at` on: what a triangle needs is worked out once for all.
#define PACKS 8
static inline void query_packs(global const float* state, int capacity, int at, int packs, int3 key,
                               global const float4* triangles, global const float* tools, global const int* list,
                               int begin, int end, float far, Closest* best) {
  for (int p = 0; p < packs; ++p) {
    best[p].distance2 = INFINITY;
    best[p].x = best[p].y = best[p].z = 0.0f;
    best[p].feature = -1;
  }
  for (int i = begin; i < end; ++i) {
    const int tool = as_int(triangles[SHELL_WORDS * list[i]].w);
    const float3 shift = convert_float3(4 * (key - window_of(tools, tool)));
    for (int p = 0; p < packs; ++p, at += NAVVY_LANES)
      closest_triangle(LOAD(FIELD_X) + shift.x, LOAD(FIELD_X + 1) + shift.y, LOAD(FIELD_X + 2) + shift.z, triangles,
                       list[i], far, best + p);
    at -= NAVVY_LANES * packs;
  }
}

// Out per near node: split (0 none, 1 in front, 2 behind), tool, and float8 (normal, phi, inset, 0 0 0) [cells].
__attribute__((reqd_work_group_size(1, 1, 1))) kernel void shell_nodes(
    global const int* restrict near_list, global const int4* restrict keys, global const float4* restrict triangles,
    const int first_rim, const int first_tool, global const int* restrict first, global const int* restrict list,
    const float band, global int* restrict node_split, global int* restrict node_tool,
    global float8* restrict node_shell) {
  global const float* tools = (global const float*)(triangles + first_tool);
  const int slot = get_global_id(0);
  const int3 key = keys[near_list[slot]].xyz;
  const real step_x = (real)(0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3);
  const real step_y = (real)(0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 2, 2, 3, 3, 3, 3);
  for (int layer = 0; layer < 4; ++layer) {
    Closest best;
    const real step_z = (float)layer;
    query(step_x, step_y, step_z, key, triangles, tools, list, first[slot], first[slot + 1], band, &best);
    // Distance along the plate to its free edge; only plates of the same tool count.
    real inset2 = INFINITY;
    float d2[16], cx[16], cy[16], cz[16], inset[16];
    int feature[16], tool_of[16];
    vstore16(best.feature, 0, feature);
    for (int l = 0; l < 16; ++l)
      tool_of[l] = feature[l] < 0 ? -1 : as_int(triangles[SHELL_WORDS * (feature[l] >> 3)].w);
    const int16 tool_lanes = vload16(0, tool_of);
    if (some(best.distance2 < band * band))
      for (int r = first_rim; r < first_tool; r += 2) {
        const real e2 = segment_distance2(best.x, best.y, best.z, triangles[r].xyz, triangles[r + 1].xyz);
        inset2 = select(inset2, fmin(inset2, e2), tool_lanes == as_int(triangles[r].w));
      }
    vstore16(best.distance2, 0, d2);
    vstore16(best.x, 0, cx);
    vstore16(best.y, 0, cy);
    vstore16(best.z, 0, cz);
    vstore16(sqrt(inset2), 0, inset);
    for (int l = 0; l < 16; ++l) {
      const int node = slot * BLOCK_NODES + 16 * layer + l;
      node_split[node] = 0;
      node_tool[node] = tool_of[l];
      if (tool_of[l] < 0) continue;
      const float3 at = convert_float3(4 * (key - window_of(tools, tool_of[l])) + (int3)(l & 3, l >> 2, layer));
      float phi;
      float3 normal;
      bool rim;
      resolve(triangles, feature[l], at - (float3)(cx[l], cy[l], cz[l]), d2[l], &phi, &normal, &rim);
      node_split[node] = rim || fabs(phi) >= band ? 0 : phi >= 0.0f ? 1 : 2;
      node_shell[node] = (float8)(normal.x, normal.y, normal.z, phi, inset[l], 0.0f, 0.0f, 0.0f);
    }
  }
}

// Gives particles their side, keeps it, and puts those that sank into a plate back on its surface (position only).
// Out: REPORT_PUSH and REPORT_CROSSED of the near homes.
__attribute__((reqd_work_group_size(1, 1, 1))) kernel void shell_particles(
    global float* restrict state, const int capacity, global const int* restrict near_list,
    global const int4* restrict homes, global const int4* restrict keys, global const float4* restrict triangles,
    const int first_tool, global const int* restrict first, global const int* restrict list, const float band,
    const float longest_push, global float* restrict report) {
  global const float* tools = (global const float*)(triangles + first_tool);
  const int near = get_global_id(0);
  const int home = near_list[near];
  const int3 key = keys[home].xyz;
  float far_push = 0.0f;
  int crossings = 0;
  const int end = homes[home].x + homes[home].y;
  Closest found[PACKS];
  int pack = PACKS;
  for (int at = homes[home].x; at < end; at += 16, ++pack) {
    const int count = min(16, end - at);
    if (pack == PACKS) {
      query_packs(state, capacity, at, min(PACKS, (end - at + 15) / 16), key, triangles, tools, list, first[near],
                  first[near + 1], band + 1.0f, found);
      pack = 0;
    }
    const Closest best = found[pack];
    const real x = LOAD(FIELD_X), y = LOAD(FIELD_X + 1), z = LOAD(FIELD_X + 2);
    // Out of the band and never inside it: nothing to keep.
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
      const Kept kept = keep_side((float3)(px[l], py[l], pz[l]), tag[l] >> 16, key, feature[l], d2[l],
                                  (float3)(cx[l], cy[l], cz[l]), band, longest_push, triangles, tools);
      px[l] = kept.x.x;
      py[l] = kept.x.y;
      pz[l] = kept.x.z;
      far_push = fmax(far_push, kept.push);
      crossings += kept.crossed;
      tag[l] = (tag[l] & 0xffff) | (kept.side << 16);
    }
    STORE(FIELD_X, vload16(0, px));
    STORE(FIELD_X + 1, vload16(0, py));
    STORE(FIELD_X + 2, vload16(0, pz));
    STORE(FIELD_TAG, as_float16(vload16(0, tag)));
  }
  report[REPORT_WORDS * home + REPORT_PUSH] = far_push;
  report[REPORT_WORDS * home + REPORT_CROSSED] = (float)crossings;
}
