// SPDX-License-Identifier: Apache-2.0
// Sorts particles into their new home blocks without atomics, inside a block by cell, in stable order.
//
// 1 rebin_count: per old home, where each particle goes (code 0..26, x fastest; 27 = left the site) and how many, and the
//   cell of its base node there (0..63, x fastest).
// 2 (host) builds the new homes from the counts, and for each the 27 old homes it takes from.
// 3 rebin_gather: per new home, the old slot of each new slot.
// 4 rebin_move: per new home, copies every field.
// One work-item per home. Host: src/soil/particles/particle_store.cpp.
#include "soil/lanes/lanes.h"

// site: x and y of its lower left and of its upper right corner [cells].
__attribute__((reqd_work_group_size(1, 1, 1))) kernel void rebin_count(
    global const float* restrict state, const int capacity, global const int4* restrict homes,
    global const int4* restrict keys, global uchar* restrict codes, global uchar* restrict cells,
    global int* restrict counts, const int4 site) {
  const int home = get_global_id(0);
  int count[28];
  for (int i = 0; i < 28; ++i) count[i] = 0;
  const float bx = 4.0f * keys[home].x, by = 4.0f * keys[home].y;
  const float x0 = site.x - bx, y0 = site.y - by, x1 = site.z - bx, y1 = site.w - by;
  for (int at = homes[home].x; at < homes[home].x + homes[home].y; ++at) {
    const float x = state[at], y = state[(size_t)capacity + at], z = state[2 * (size_t)capacity + at];
    const int3 base = convert_int3_rtn((float3)(x, y, z) - 0.5f);
    const int3 d = select(select((int3)(0), (int3)(1), base > 3), (int3)(-1), base < 0);
    const bool outside = x < x0 || x >= x1 || y < y0 || y >= y1;
    const int code = outside ? 27 : (d.x + 1) + 3 * (d.y + 1) + 9 * (d.z + 1);
    codes[at] = code;
    const int3 in_home = clamp(base - 4 * d, 0, 3);
    cells[at] = in_home.x + 4 * in_home.y + 16 * in_home.z;
    ++count[code];
  }
  for (int i = 0; i < 28; ++i) counts[28 * home + i] = count[i];
}

// sources[27 * new + n] = old home from which code n leads here, or -1. Particles of one cell stand together, in the order
// of their arrival: scatter and gather then work on the same nodes for a while.
__attribute__((reqd_work_group_size(1, 1, 1))) kernel void rebin_gather(
    global const int4* restrict old_homes, global const uchar* restrict codes, global const uchar* restrict cells,
    global const int* restrict counts, global const int4* restrict homes, global const int* restrict sources,
    global int* restrict from) {
  const int home = get_global_id(0);
  int next[65];
  for (int i = 0; i < 65; ++i) next[i] = 0;
  for (int pass = 0; pass < 2; ++pass) {
    for (int n = 0; n < 27; ++n) {
      const int old = sources[27 * home + n];
      if (old < 0) continue;
      int left = counts[28 * old + n];
      for (int at = old_homes[old].x; left > 0; ++at) {
        if (codes[at] != n) continue;
        if (pass == 0) ++next[cells[at] + 1];
        else from[next[cells[at]]++] = at;
        --left;
      }
    }
    if (pass == 1) break;
    next[0] = homes[home].x;
    for (int i = 1; i < 65; ++i) next[i] += next[i - 1];
  }
}

// Also the mean surface of each home (tan of the tool friction angle, adhesion [Pa], 1 / bank density [m3/kg], 0), and
// the lanes past its count, which get mass 0.
__attribute__((reqd_work_group_size(1, 1, 1))) kernel void rebin_move(
    global const float* restrict old_state, const int old_capacity, global const uchar* restrict codes,
    global const int* restrict from, global const int4* restrict homes, global float* restrict state,
    const int capacity, constant float* soils, global float4* restrict home_surface) {
  const int home = get_global_id(0);
  const int start = homes[home].x, end = start + homes[home].y;
  const int padded = (end + NAVVY_LANES - 1) / NAVVY_LANES * NAVVY_LANES;
  for (int f = 0; f < FIELD_COUNT; ++f) {
    global const float* in = old_state + (size_t)f * old_capacity;
    global float* out = state + (size_t)f * capacity;
    for (int at = start; at < end; ++at) out[at] = in[from[at]];
    const float rest = f < FIELD_X + 3 ? 2.0f : (f == FIELD_J || f == FIELD_J0) ? 1.0f : 0.0f;
    for (int at = end; at < padded; ++at) out[at] = rest;
  }
  // Differences from the first: a home of one soil has its values to the last bit.
  float4 first = (float4)(0.0f), more = (float4)(0.0f);
  for (int at = start; at < end; ++at) {
    const int3 d = neighbour_offset(codes[from[at]]);
    state[at] -= 4.0f * d.x;
    state[(size_t)capacity + at] -= 4.0f * d.y;
    state[2 * (size_t)capacity + at] -= 4.0f * d.z;
    const int tag = as_int(state[(size_t)FIELD_TAG * capacity + at]);
    constant float* soil = soils + (tag & 0xffff) * SOIL_WORDS;
    const float4 here = (float4)(soil[SOIL_TOOL_FRICTION], soil[SOIL_ADHESION], soil[SOIL_INV_DENSITY], 0.0f);
    if (at == start) first = here;
    more += here - first;
  }
  home_surface[home] = first + more / (float)max(end - start, 1);
}
