// SPDX-License-Identifier: Apache-2.0
// Sorts particles into their new blocks, within a block by cell, in stable order: schedule of
// work-groups.
//
// In, Out: as in soil/lanes/rebin.cl, in the same order.
//
// Parallel: one work-group per block. Repeatable: counts use integer atomics, whose order does not
// matter; one work-item per cell finds the order within it. Host: src/soil/particles/rebin.cpp.
#include "soil/groups/group.h"
#include "soil/place.h"

#define MEMBERS 64

// Counts. site, removed: as in soil/lanes/rebin.cl.
__attribute__((reqd_work_group_size(MEMBERS, 1, 1))) kernel void rebin_count(
    global const float* restrict state, const int capacity,
    global const ParticleBlock* restrict particle_blocks, global const int4* restrict keys,
    global uchar* restrict codes, global uchar* restrict cells, global int* restrict counts,
    const int4 site, global const uchar* restrict removed, const int removing) {
  local int count[CODES];
  const int particle_block = group_index(), me = get_local_id(0);
  if (me < CODES) count[me] = 0;
  barrier(CLK_LOCAL_MEM_FENCE);
  const float4 from_block = site_from(site, keys[particle_block]);
  for (int slot = particle_blocks[particle_block].start + me;
       slot < particle_blocks[particle_block].start + particle_blocks[particle_block].count;
       slot += MEMBERS) {
    if (removing && removed[slot]) {
      codes[slot] = REMOVED;
      continue;
    }
    const Place place = place_of(LOAD(FIELD_X), LOAD(FIELD_X + 1), LOAD(FIELD_X + 2), from_block);
    codes[slot] = place.code;
    cells[slot] = place.cell;
    atomic_inc(&count[place.code]);
  }
  barrier(CLK_LOCAL_MEM_FENCE);
  if (me < CODES) counts[CODES * particle_block + me] = count[me];
}

// Lists the old slots of each new block. A work-item is a cell of the new block. It counts, then
// lists its particles, taking the sources in order.
__attribute__((reqd_work_group_size(MEMBERS, 1, 1))) kernel void rebin_gather(
    global const ParticleBlock* restrict old_particle_blocks, global const uchar* restrict codes,
    global const uchar* restrict cells, global const int* restrict counts,
    global const ParticleBlock* restrict particle_blocks, global const int* restrict sources,
    global int* restrict from, const int ascending) {
  local int found[MEMBERS];
  local uchar cell[MEMBERS];
  const int particle_block = group_index(), me = get_local_id(0);
  int next = 0;
  for (int pass = 0; pass < 2; ++pass) {
    for (int i = 0; i < SOURCES; ++i) {
      const int old = sources[SOURCES * particle_block + i], n = code_of_source(i, ascending);
      const int end = old < 0 ? 0 : old_particle_blocks[old].start + old_particle_blocks[old].count;
      int left = old < 0 ? 0 : counts[CODES * old + n];
      for (int begin = old < 0 ? 0 : old_particle_blocks[old].start; begin < end && left > 0;
           begin += MEMBERS) {
        const int slot = begin + me;
        cell[me] = slot < end && codes[slot] == n ? cells[slot] : (uchar)255;
        barrier(CLK_LOCAL_MEM_FENCE);
        for (int k = 0; k < MEMBERS; ++k) {
          left -= cell[k] != 255;
          if (cell[k] != me) continue;
          if (pass == 1) from[next] = begin + k;
          ++next;
        }
        barrier(CLK_LOCAL_MEM_FENCE);
      }
    }
    if (pass == 0) {
      found[me] = next;
      barrier(CLK_LOCAL_MEM_FENCE);
      next = particle_blocks[particle_block].start;
      for (int i = 0; i < me; ++i) next += found[i];
    }
  }
}

// Copies every field. Also computes the mean surface of each block (soil/lanes/rebin.cl), and sets
// the mass of lanes beyond its count to 0.
__attribute__((reqd_work_group_size(MEMBERS, 1, 1))) kernel void rebin_move(
    global const float* restrict old_state, const int old_capacity,
    global const uchar* restrict codes, global const int* restrict from,
    global const ParticleBlock* restrict particle_blocks, global float* restrict state,
    const int capacity, constant SoilRow* soils, global float4* restrict block_surface,
    global const float* restrict added, const int added_count) {
  local float4 surface[MEMBERS];
  const int particle_block = group_index(), me = get_local_id(0);
  const int start = particle_blocks[particle_block].start,
            end = start + particle_blocks[particle_block].count;
  const int padded = (end + NAVVY_LANES - 1) / NAVVY_LANES * NAVVY_LANES;
  // Differences from the first particle: the mean of a single soil is then exact.
  float4 first = 0.0f, sum = 0.0f;
  if (end > start) {
    const int old = from[start];
    const float tag = old < old_capacity
                          ? old_state[(size_t)FIELD_TAG * old_capacity + old]
                          : added[(size_t)FIELD_TAG * added_count + old - old_capacity];
    first = surface_of(soils + (as_int(tag) & 0xffff));
  }
  for (int slot = start + me; slot < padded; slot += MEMBERS) {
    const bool empty = slot >= end;
    const int old = empty ? 0 : from[slot];
    global const float* in = old < old_capacity ? old_state + old : added + (old - old_capacity);
    const size_t stride = old < old_capacity ? old_capacity : added_count;
    for (int f = 0; f < FIELD_COUNT; ++f) {
      STORE(f, empty ? rest_of(f) : in[f * stride]);
    }
    if (empty) continue;
    const int3 d = neighbour_offset(codes[old]);
    LOAD(FIELD_X) -= 4.0f * d.x;
    LOAD(FIELD_X + 1) -= 4.0f * d.y;
    LOAD(FIELD_X + 2) -= 4.0f * d.z;
    sum += surface_of(soils + (as_int(LOAD(FIELD_TAG)) & 0xffff)) - first;
  }
  surface[me] = sum;
  barrier(CLK_LOCAL_MEM_FENCE);
  for (int members = MEMBERS / 2; members > 0; members /= 2) {
    if (me < members) surface[me] += surface[me + members];
    barrier(CLK_LOCAL_MEM_FENCE);
  }
  if (me == 0) block_surface[particle_block] = first + surface[0] / (float)max(end - start, 1);
}
