// SPDX-License-Identifier: Apache-2.0
// Sorts particles into their new home blocks, inside a block by cell, in stable order: schedule of work-groups.
//
// In, Out: as in soil/rebin.cl, and the same order. One work-group per home. Counting uses integer atomics, whose order
// does not matter; the order inside a cell is found by one work-item per cell. Host: src/soil/particles/particle_store.cpp.
#include "soil/groups/group.h"

#define MEMBERS 64

// site: x and y of its lower left and of its upper right corner [cells].
__attribute__((reqd_work_group_size(MEMBERS, 1, 1))) kernel void rebin_count(
    global const float* restrict state, const int capacity, global const int4* restrict homes,
    global const int4* restrict keys, global uchar* restrict codes, global uchar* restrict cells,
    global int* restrict counts, const int4 site) {
  local int count[28];
  const int home = get_group_id(0), me = get_local_id(0);
  if (me < 28) count[me] = 0;
  barrier(CLK_LOCAL_MEM_FENCE);
  const float bx = 4.0f * keys[home].x, by = 4.0f * keys[home].y;
  const float x0 = site.x - bx, y0 = site.y - by, x1 = site.z - bx, y1 = site.w - by;
  for (int at = homes[home].x + me; at < homes[home].x + homes[home].y; at += MEMBERS) {
    const float x = LOAD(FIELD_X), y = LOAD(FIELD_X + 1), z = LOAD(FIELD_X + 2);
    const int3 base = convert_int3_rtn((float3)(x, y, z) - 0.5f);
    const int3 d = select(select((int3)(0), (int3)(1), base > 3), (int3)(-1), base < 0);
    const bool outside = x < x0 || x >= x1 || y < y0 || y >= y1;
    const int code = outside ? 27 : (d.x + 1) + 3 * (d.y + 1) + 9 * (d.z + 1);
    const int3 in_home = clamp(base - 4 * d, 0, 3);
    codes[at] = (uchar)code;
    cells[at] = (uchar)(in_home.x + 4 * in_home.y + 16 * in_home.z);
    atomic_inc(&count[code]);
  }
  barrier(CLK_LOCAL_MEM_FENCE);
  if (me < 28) counts[28 * home + me] = count[me];
}

// A work-item is a cell of the new home: it counts, then lists its particles, taking the sources in order.
__attribute__((reqd_work_group_size(MEMBERS, 1, 1))) kernel void rebin_gather(
    global const int4* restrict old_homes, global const uchar* restrict codes, global const uchar* restrict cells,
    global const int* restrict counts, global const int4* restrict homes, global const int* restrict sources,
    global int* restrict from) {
  local int found[MEMBERS];
  local uchar cell[MEMBERS];
  const int home = get_group_id(0), me = get_local_id(0);
  int next = 0;
  for (int pass = 0; pass < 2; ++pass) {
    for (int n = 0; n < 27; ++n) {
      const int old = sources[27 * home + n];
      const int end = old < 0 ? 0 : old_homes[old].x + old_homes[old].y;
      int left = old < 0 ? 0 : counts[28 * old + n];
      for (int begin = old < 0 ? 0 : old_homes[old].x; begin < end && left > 0; begin += MEMBERS) {
        const int at = begin + me;
        cell[me] = at < end && codes[at] == n ? cells[at] : (uchar)255;
        barrier(CLK_LOCAL_MEM_FENCE);
        for (int i = 0; i < MEMBERS; ++i) {
          left -= cell[i] != 255;
          if (cell[i] != me) continue;
          if (pass == 1) from[next] = begin + i;
          ++next;
        }
        barrier(CLK_LOCAL_MEM_FENCE);
      }
    }
    if (pass == 0) {
      found[me] = next;
      barrier(CLK_LOCAL_MEM_FENCE);
      next = homes[home].x;
      for (int i = 0; i < me; ++i) next += found[i];
    }
  }
}

static inline float4 surface_of(constant float* soils, int tag) {
  constant float* soil = soils + (tag & 0xffff) * SOIL_WORDS;
  return (float4)(soil[SOIL_TOOL_FRICTION], soil[SOIL_ADHESION], soil[SOIL_INV_DENSITY], 0.0f);
}

// Also the mean surface of each home (soil/rebin.cl), and the lanes past its count, which get mass 0.
__attribute__((reqd_work_group_size(MEMBERS, 1, 1))) kernel void rebin_move(
    global const float* restrict old_state, const int old_capacity, global const uchar* restrict codes,
    global const int* restrict from, global const int4* restrict homes, global float* restrict state,
    const int capacity, constant float* soils, global float4* restrict home_surface) {
  local float4 surface[MEMBERS];
  const int home = get_group_id(0), me = get_local_id(0);
  const int start = homes[home].x, end = start + homes[home].y;
  const int padded = (end + NAVVY_LANES - 1) / NAVVY_LANES * NAVVY_LANES;
  // Differences from the first particle's: a home of one soil has its values to the last bit.
  float4 first = 0.0f, sum = 0.0f;
  if (end > start)
    first = surface_of(soils, as_int(old_state[(size_t)FIELD_TAG * old_capacity + from[start]]));
  for (int at = start + me; at < padded; at += MEMBERS) {
    const bool empty = at >= end;
    const int old = empty ? 0 : from[at];
    for (int f = 0; f < FIELD_COUNT; ++f) {
      const float rest = f < FIELD_X + 3 ? 2.0f : (f == FIELD_J || f == FIELD_J0) ? 1.0f : 0.0f;
      STORE(f, empty ? rest : old_state[(size_t)f * old_capacity + old]);
    }
    if (empty) continue;
    const int3 d = neighbour_offset(codes[old]);
    LOAD(FIELD_X) -= 4.0f * d.x;
    LOAD(FIELD_X + 1) -= 4.0f * d.y;
    LOAD(FIELD_X + 2) -= 4.0f * d.z;
    sum += surface_of(soils, as_int(LOAD(FIELD_TAG))) - first;
  }
  surface[me] = sum;
  barrier(CLK_LOCAL_MEM_FENCE);
  for (int members = MEMBERS / 2; members > 0; members /= 2) {
    if (me < members) surface[me] += surface[me + members];
    barrier(CLK_LOCAL_MEM_FENCE);
  }
  if (me == 0) home_surface[home] = first + surface[0] / (float)max(end - start, 1);
}
