// SPDX-License-Identifier: Apache-2.0
// Counts the mass of every block exactly, once per transfer: schedule of work-groups.
//
// In, Out: as in soil/lanes/mass_count.cl.
//
// Parallel: one work-group per block. Repeatable: integer sums do not depend on order. Host:
// src/soil/particles/mass_count.cpp; reference: ParticleStore::masses.
#include "soil/groups/group.h"

#define MEMBERS 64

__attribute__((reqd_work_group_size(MEMBERS, 1, 1))) kernel void mass_count(
    global const int* restrict state, const int capacity,
    global const ParticleBlock* restrict particle_blocks, global long* restrict masses,
    const int soils) {
  local long sums[MEMBERS];
  const int particle_block = group_index(), me = get_local_id(0);
  for (int soil = 0; soil < soils; ++soil) {
    long sum = 0;
    for (int slot = particle_blocks[particle_block].start + me;
         slot < particle_blocks[particle_block].start + particle_blocks[particle_block].count;
         slot += MEMBERS)
      sum += (LOAD(FIELD_TAG) & 0xffff) == soil ? LOAD(FIELD_MASS) : 0;
    sums[me] = sum;
    barrier(CLK_LOCAL_MEM_FENCE);
    for (int half_size = MEMBERS / 2; half_size > 0; half_size /= 2) {
      if (me < half_size) sums[me] += sums[me + half_size];
      barrier(CLK_LOCAL_MEM_FENCE);
    }
    if (me == 0) masses[soils * particle_block + soil] = sums[0];
    barrier(CLK_LOCAL_MEM_FENCE);
  }
}
