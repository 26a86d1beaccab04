// SPDX-License-Identifier: Apache-2.0
// Sums the strength of the soil around the free edges of plates, block by block.
//
// In: state, soils, particle blocks (layout.h); list = blocks with soil around edges; first /
// points: points on the edges near each of them (compressed rows), x, y, z from the block's corner
// [cells].
//
// Parallel: one work-item per block. Repeatable: fixed order of sums. Host:
// src/soil/tools/edge.cpp.
#include "soil/lanes/lanes.h"
#include "soil/edge_strength.h"

// Returns the sum of all lanes.
static inline float total(real lanes) {
  const float8 eight = lanes.lo + lanes.hi;
  const float4 four = eight.lo + eight.hi;
  return (four.x + four.y) + (four.z + four.w);
}

// Out: float4 per listed block: weighted sums over particles of mass [mass quanta], mass x cohesion
// [Pa], mass x sin phi.
__attribute__((reqd_work_group_size(1, 1, 1))) kernel void edge_strength(
    global const float* restrict state, const int capacity, constant SoilRow* soils,
    const int soil_count, global const ParticleBlock* restrict particle_blocks,
    global const int* restrict list, global const int* restrict first,
    global const float4* restrict points, global float4* restrict strength) {
  const int entry = group_index();
  const ParticleBlock block = particle_blocks[list[entry]];
  EdgeSums sums = {0.0f, 0.0f, 0.0f};
  for (int slot = block.start; slot < block.start + block.count; slot += NAVVY_LANES) {
    const real weight = edge_weight(LOAD(FIELD_X), LOAD(FIELD_X + 1), LOAD(FIELD_X + 2), points,
                                    first[entry], first[entry + 1]);
    // Unused lanes have no mass.
    const real mass = weight * convert_float16(as_int16(LOAD(FIELD_MASS)));
    if (!some(mass > 0.0f)) continue;
    const int16 kind = as_int16(LOAD(FIELD_TAG)) & 0xffff;
    for (int soil = 0; soil < soil_count; ++soil) {
      const real mine = kind == soil ? mass : (real)(0.0f);
      if (some(mine > 0.0f))
        add_strength(&sums, soils + soil, mine, LOAD(FIELD_J), LOAD(FIELD_J0), LOAD(FIELD_SHEAR));
    }
  }
  strength[entry] =
      (float4)(total(sums.mass), total(sums.cohesion), total(sums.sin_phi), 0.0f);
}
