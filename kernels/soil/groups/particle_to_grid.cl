// SPDX-License-Identifier: Apache-2.0
// Updates the stress of each particle, then scatters mass and momentum to the tile of its block:
// schedule of work-groups.
//
// In, Out: as in soil/lanes/particle_to_grid.cl, tiles without padding.
//
// Parallel: one work-group per block. A work-item is first one particle of a chunk (law), then one
// cell of base nodes. It adds up the particles of the cell for three layers of nodes in turn, and
// adds the nine nodes of a layer to the tile one offset after the other. Cells of one offset share
// no node, so nothing is atomic. Repeatable: particles in stored order, cell by cell. Host:
// src/soil/particles/particle_to_grid.cpp. Reference:
// tests/soil/reference/reference_solver.cpp.
#include "soil/groups/chunk.h"

static inline LawSoil load_soil(constant SoilRow* row) {
  LawSoil soil;
#define SOIL_CONSTANT(name) soil.name = row->name;
  LAW_CONSTANTS(SOIL_CONSTANT)
  return soil;
}

// Computes law and momentum of the particle in `slot`. Returns false when a value is not finite.
// out: STAGED words.
static inline bool prepare(global float* state, int capacity, int slot, constant SoilRow* soils,
                           float opening, float dt, float dx, float mixing, float most_mixing,
                           float carried, float* out) {
  constant SoilRow* row = soils + (as_int(LOAD(FIELD_TAG)) & 0xffff);
  const LawSoil soil = load_soil(row);
  float c[9], sigma[6];
  LawState soil_state;
  UNROLL
  for (int k = 0; k < 9; ++k) c[k] = LOAD(FIELD_C + k);
  LAW_STATE_FIELDS(LOAD_ONE, LOAD_MANY)
  advance_state(c, dt, &soil, opening, mixing, most_mixing, &soil_state, sigma);
  LAW_STATE_FIELDS(STORE_ONE, STORE_MANY)

  const float x = LOAD(FIELD_X), y = LOAD(FIELD_X + 1), z = LOAD(FIELD_X + 2);
  const float f[3] = {x - base_node(x), y - base_node(y), z - base_node(z)};
  const float v[3] = {LOAD(FIELD_V), LOAD(FIELD_V + 1), LOAD(FIELD_V + 2)};
  const float mass = convert_float(as_int(LOAD(FIELD_MASS))) * MASS_QUANTUM;
  float p[3], a[9];
  affine_momentum(c, sigma, v, f, mass, mass * row->inv_density, soil_state.j, carried, dt, dx, p,
                  a);
  UNROLL
  for (int i = 0; i < 3; ++i) {
    out[STAGED_P + i] = p[i];
    out[STAGED_F + i] = f[i];
    UNROLL
    for (int k = 0; k < 3; ++k) out[STAGED_A + 3 * k + i] = a[3 * i + k];
  }
  out[STAGED_MASS] = mass;
  // A sum is finite only if each term is.
  const float sum = (x + y + z) + (p[0] + p[1] + p[2]) + (a[0] + a[4] + a[8]) +
                    (soil_state.j + soil_state.j0 + soil_state.shear) +
                    (soil_state.s[3] + soil_state.s[4] + soil_state.s[5]);
  return isfinite(sum);
}

// Returns the mean opening J / J0 of a cell, by mass, 0 where no particle is open (mean_opening in
// soil/point.h). A work-item is a cell.
static inline float cell_opening(global const float* state, int capacity,
                                 ParticleBlock particle_block, local int* cells,
                                 local float* stage) {
  const int me = get_local_id(0);
  float volume = 0.0f, bank = 0.0f;
  bool open = false;
  for (int begin = 0; begin < particle_block.count; begin += CHUNK) {
    const int count = min(CHUNK, particle_block.count - begin);
    const int slot = particle_block.start + begin + me;
    if (me < count) {
      const float mass = convert_float(as_int(LOAD(FIELD_MASS)));
      cells[me] = cell_of(LOAD(FIELD_X), LOAD(FIELD_X + 1), LOAD(FIELD_X + 2));
      stage[me] = mass * LOAD(FIELD_J);
      stage[CHUNK + me] = mass * LOAD(FIELD_J0);
    }
    barrier(CLK_LOCAL_MEM_FENCE);
    for (int i = 0; i < count; ++i) {
      if (cells[i] != me) continue;
      volume += stage[i];
      bank += stage[CHUNK + i];
      open |= stage[i] > stage[CHUNK + i];
    }
    barrier(CLK_LOCAL_MEM_FENCE);
  }
  return mean_opening(volume, bank, open ? 1.0f : 0.0f);
}

// Returns what a block needs: bit 0 always, bits 1 and 2 for the tiles of a shell's sides, bit 3
// when any particle is open.
static inline int needs(global float* state, int capacity, ParticleBlock particle_block) {
  int out = 1;
  for (int i = get_local_id(0); i < particle_block.count; i += CELLS) {
    const int slot = particle_block.start + i, tag = as_int(LOAD(FIELD_TAG));
    out |= LOAD(FIELD_J) > LOAD(FIELD_J0) ? 8 : 0;
    if (particle_block.near)
      out |= 1 << tile_of(tag >> 16);
    else
      // Far from every shell no particle has a side.
      STORE(FIELD_TAG, as_float(tag & 0xffff));
  }
  return out;
}

__attribute__((reqd_work_group_size(CELLS, 1, 1))) kernel void particle_to_grid(
    global float* restrict state, const int capacity, constant SoilRow* soils,
    global const ParticleBlock* restrict particle_blocks, global float4* restrict tiles,
    global int* restrict used, global Report* restrict report, const float dt, const float dx,
    const float mixing, const float most_mixing, const float carried) {
  local float4 tile[TILE_SIZE];
  local float stage[STAGED * CHUNK];
  local int cells[CHUNK], sides[CHUNK], first[CELLS], counts[CELLS];
  local float openings[CELLS];
  local int wanted, broken;
  const int block = get_group_id(0), me = get_local_id(0);
  const ParticleBlock particle_block = particle_blocks[block];
  if (me == 0) wanted = broken = 0;
  barrier(CLK_LOCAL_MEM_FENCE);
  atomic_or(&wanted, needs(state, capacity, particle_block));
  for (int i = me; i < TILE_SIZE; i += CELLS) tile[i] = (float4)(0.0f);
  openings[me] = 0.0f;
  barrier(CLK_LOCAL_MEM_FENCE | CLK_GLOBAL_MEM_FENCE);
  const int mask = wanted & 7;
  for (int t = 1; mask >> t; ++t)
    for (int i = me; i < TILE_SIZE; i += CELLS)
      tiles[(size_t)(particle_block.tile + t) * TILE_NODES + i] = (float4)(0.0f);
  if (wanted & 8) openings[me] = cell_opening(state, capacity, particle_block, cells, stage);
  barrier(CLK_LOCAL_MEM_FENCE | CLK_GLOBAL_MEM_FENCE);

  for (int begin = 0; begin < particle_block.count; begin += CHUNK) {
    const int count = min(CHUNK, particle_block.count - begin);
    float mine[STAGED];
    int cell = 0, side = 0;
    first[me] = counts[me] = 0;
    if (me < count) {
      const int slot = particle_block.start + begin + me;
      cell = cell_of(LOAD(FIELD_X), LOAD(FIELD_X + 1), LOAD(FIELD_X + 2));
      side = tile_of(as_int(LOAD(FIELD_TAG)) >> 16);
      if (!prepare(state, capacity, slot, soils, openings[cell], dt, dx, mixing, most_mixing,
                   carried, mine))
        atomic_or(&broken, 1);
      cells[me] = cell;
    }
    barrier(CLK_LOCAL_MEM_FENCE);
    if (me < count) {
      const int place = place_in_chunk(cells, count, cell, first, counts);
      sides[place] = side;
      UNROLL
      for (int f = 0; f < STAGED; ++f) stage[f * CHUNK + place] = mine[f];
    }
    barrier(CLK_LOCAL_MEM_FENCE);
    for (int t = 0; mask >> t; ++t)
      if (mask >> t & 1)
        for (int layer = 0; layer < 3; ++layer) {
          float4 sums[9];
          add_layer(stage, sides, first[me], counts[me], t, layer, sums);
          UNROLL
          for (int o = 0; o < 9; ++o) {
            const int node = tile_node(me) + o % 3 + 8 * (o / 3) + 64 * layer;
            if (counts[me] > 0) {
              if (t == 0)
                tile[node] += sums[o];
              else
                tiles[(size_t)(particle_block.tile + t) * TILE_NODES + node] += sums[o];
            }
            barrier(CLK_LOCAL_MEM_FENCE | CLK_GLOBAL_MEM_FENCE);
          }
        }
  }
  for (int i = me; i < TILE_SIZE; i += CELLS)
    tiles[(size_t)particle_block.tile * TILE_NODES + i] = tile[i];
  if (me > 0) return;
  used[block] = mask;
  report[block].broken = broken;
  // Otherwise soil/groups/shell.cl has written them.
  if (!particle_block.near) {
    report[block].push = 0.0f;
    report[block].crossed = 0;
  }
}
