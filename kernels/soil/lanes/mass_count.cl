// SPDX-License-Identifier: Apache-2.0
// Counts the mass of every block exactly, once per transfer.
//
// In: state, particle blocks (layout.h), number of soils.
// Out: masses[soils * block + soil], 64-bit, in mass quanta (2^-24 kg). Lanes beyond a block's
// count have mass 0.
//
// Parallel: one work-item per block. Repeatable: integer sums do not depend on order. Host:
// src/soil/particles/mass_count.cpp; reference: ParticleStore::masses.
#include "soil/lanes/lanes.h"

__attribute__((reqd_work_group_size(1, 1, 1))) kernel void mass_count(
    global const int* restrict state, const int capacity,
    global const ParticleBlock* restrict particle_blocks, global long* restrict masses,
    const int soils) {
  const int particle_block = group_index();
  const global int* mass = state + FIELD_MASS * (size_t)capacity;
  const global int* tag = state + FIELD_TAG * (size_t)capacity;
  const int start = particle_blocks[particle_block].start,
            end = start + particle_blocks[particle_block].count;
  for (int soil = 0; soil < soils; ++soil) {
    long16 sum = (long16)(0);
    for (int slot = start; slot < end; slot += NAVVY_LANES) {
      const int16 mine = (vload16(0, tag + slot) & 0xffff) == soil;
      sum += convert_long16(vload16(0, mass + slot) & mine);
    }
    const long8 half_sum = sum.lo + sum.hi;
    const long4 quarter = half_sum.lo + half_sum.hi;
    masses[soils * particle_block + soil] = quarter.x + quarter.y + quarter.z + quarter.w;
  }
}
