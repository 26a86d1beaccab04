// SPDX-License-Identifier: Apache-2.0
// Sorts particles into their new blocks without atomics, within a block by cell, in stable order.
//
// 1 rebin_count, per old block: where each particle goes (code 0..26, x fastest; 27 = left the
// site), how many go there, and the cell of the base node there (0..63, x fastest).
//
// 2 (host): builds the new blocks from the counts, and for each the old blocks that it takes
// particles from. Particles that are added stand in further old blocks, in slots from old_capacity
// on; all their words are in `added`.
//
// 3 rebin_gather, per new block: the old slot of each new slot.
//
// 4 rebin_move, per new block: copies every field.
//
// Parallel: one work-item per block. Repeatable: stable order. Host: src/soil/particles/rebin.cpp.
#include "soil/lanes/lanes.h"
#include "soil/place.h"

// Counts. site: x and y of its lower left and of its upper right corner [cells]. removed: one flag
// per slot, not 0 if the particle is removed; read if `removing` is not 0.
__attribute__((reqd_work_group_size(1, 1, 1))) kernel void rebin_count(
    global const float* restrict state, const int capacity,
    global const ParticleBlock* restrict particle_blocks, global const int4* restrict keys,
    global uchar* restrict codes, global uchar* restrict cells, global int* restrict counts,
    const int4 site, global const uchar* restrict removed, const int removing) {
  const int particle_block = group_index();
  const float4 from_block = site_from(site, keys[particle_block]);
  int count[CODES];
  for (int i = 0; i < CODES; ++i) count[i] = 0;
  for (int slot = particle_blocks[particle_block].start;
       slot < particle_blocks[particle_block].start + particle_blocks[particle_block].count;
       ++slot) {
    if (removing && removed[slot]) {
      codes[slot] = REMOVED;
      continue;
    }
    const Place place = place_of(state[slot], state[(FIELD_X + 1) * (size_t)capacity + slot],
                                 state[(FIELD_X + 2) * (size_t)capacity + slot], from_block);
    codes[slot] = place.code;
    cells[slot] = place.cell;
    ++count[place.code];
  }
  for (int i = 0; i < CODES; ++i) counts[CODES * particle_block + i] = count[i];
}

// Lists the old slots of each new block. sources[SOURCES * new + i] = old block from which code
// code_of_source(i) leads here, or -1. Particles of one cell are stored together, in the order of
// their arrival: scatter and gather then work on the same nodes for a while.
__attribute__((reqd_work_group_size(1, 1, 1))) kernel void rebin_gather(
    global const ParticleBlock* restrict old_particle_blocks, global const uchar* restrict codes,
    global const uchar* restrict cells, global const int* restrict counts,
    global const ParticleBlock* restrict particle_blocks, global const int* restrict sources,
    global int* restrict from, const int ascending) {
  const int particle_block = group_index();
  int next[65];
  for (int i = 0; i < 65; ++i) next[i] = 0;
  for (int pass = 0; pass < 2; ++pass) {
    for (int i = 0; i < SOURCES; ++i) {
      const int old = sources[SOURCES * particle_block + i], n = code_of_source(i, ascending);
      if (old < 0) continue;
      int left = counts[CODES * old + n];
      for (int slot = old_particle_blocks[old].start; left > 0; ++slot) {
        if (codes[slot] != n) continue;
        if (pass == 0)
          ++next[cells[slot] + 1];
        else
          from[next[cells[slot]]++] = slot;
        --left;
      }
    }
    if (pass == 1) break;
    next[0] = particle_blocks[particle_block].start;
    for (int i = 1; i < 65; ++i) next[i] += next[i - 1];
  }
}

// Copies every field. Also computes the mean surface of each block (ContactSoil), and sets the mass
// of lanes beyond its count to 0.
__attribute__((reqd_work_group_size(1, 1, 1))) kernel void rebin_move(
    global const float* restrict old_state, const int old_capacity,
    global const uchar* restrict codes, global const int* restrict from,
    global const ParticleBlock* restrict particle_blocks, global float* restrict state,
    const int capacity, constant SoilRow* soils, global float4* restrict block_surface,
    global const float* restrict added, const int added_count) {
  const int particle_block = group_index();
  const int start = particle_blocks[particle_block].start,
            end = start + particle_blocks[particle_block].count;
  const int padded = (end + NAVVY_LANES - 1) / NAVVY_LANES * NAVVY_LANES;
  for (int f = 0; f < FIELD_COUNT; ++f) {
    global const float* in = old_state + (size_t)f * old_capacity;
    global float* out = state + (size_t)f * capacity;
    if (added_count == 0) {
      for (int slot = start; slot < end; ++slot) out[slot] = in[from[slot]];
    } else {
      global const float* more = added + (size_t)f * added_count;
      for (int slot = start; slot < end; ++slot)
        out[slot] = from[slot] < old_capacity ? in[from[slot]] : more[from[slot] - old_capacity];
    }
    const float rest = rest_of(f);
    for (int slot = end; slot < padded; ++slot) out[slot] = rest;
  }
  // Differences from the first particle: the mean of a single soil is then exact.
  float4 first = (float4)(0.0f), more = (float4)(0.0f);
  for (int slot = start; slot < end; ++slot) {
    const int3 d = neighbour_offset(codes[from[slot]]);
    state[slot] -= 4.0f * d.x;
    state[(FIELD_X + 1) * (size_t)capacity + slot] -= 4.0f * d.y;
    state[(FIELD_X + 2) * (size_t)capacity + slot] -= 4.0f * d.z;
    const int tag = as_int(state[(size_t)FIELD_TAG * capacity + slot]);
    const float4 here = surface_of(soils + (tag & 0xffff));
    if (slot == start) first = here;
    more += here - first;
  }
  block_surface[particle_block] = first + more / (float)max(end - start, 1);
}
