// SPDX-License-Identifier: Apache-2.0
// Sums the strength of the soil around the free edges of plates: schedule of work-groups.
//
// In, Out: as in soil/lanes/edge.cl.
//
// Parallel: one work-group per block, one particle per work-item. Repeatable: sums are
// added pairwise in a fixed order. Host: src/soil/tools/edge.cpp.
#include "soil/groups/group.h"
#include "soil/edge_strength.h"

#define MEMBERS 64

__attribute__((reqd_work_group_size(MEMBERS, 1, 1))) kernel void edge_strength(
    global const float* restrict state, const int capacity, constant SoilRow* soils,
    const int soil_count, global const ParticleBlock* restrict particle_blocks,
    global const int* restrict list, global const int* restrict first,
    global const float4* restrict points, global float4* restrict strength) {
  local float4 parts[MEMBERS];
  const int entry = group_index(), me = get_local_id(0);
  const ParticleBlock block = particle_blocks[list[entry]];
  EdgeSums sums = {0.0f, 0.0f, 0.0f};
  for (int slot = block.start + me; slot < block.start + block.count; slot += MEMBERS) {
    const float weight = edge_weight(LOAD(FIELD_X), LOAD(FIELD_X + 1), LOAD(FIELD_X + 2), points,
                                     first[entry], first[entry + 1]);
    const float mass = weight * convert_float(as_int(LOAD(FIELD_MASS)));
    const int soil = as_int(LOAD(FIELD_TAG)) & 0xffff;
    if (mass > 0.0f && soil < soil_count)
      add_strength(&sums, soils + soil, mass, LOAD(FIELD_J), LOAD(FIELD_J0), LOAD(FIELD_SHEAR));
  }
  parts[me] = (float4)(sums.mass, sums.cohesion, sums.sin_phi, 0.0f);
  barrier(CLK_LOCAL_MEM_FENCE);
  for (int left = MEMBERS / 2; left > 0; left /= 2) {
    if (me < left) parts[me] += parts[me + left];
    barrier(CLK_LOCAL_MEM_FENCE);
  }
  if (me == 0) strength[entry] = parts[0];
}
