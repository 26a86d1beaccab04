// SPDX-License-Identifier: Apache-2.0
// Updates the stress of each particle, then scatters mass and momentum to the tile of its block:
// schedule of work-groups.
//
// In, Out: as in soil/lanes/particle_to_grid.cl, tiles without padding.
//
// Parallel: one work-group per block. For openings a work-item is a cell, for the law a particle of
// a chunk. To sum, 27 of the 32 work-items of a team share a row of six cells: each takes every
// third node of one of the nine lines of nodes that the row touches. Last, a work-item owns two
// nodes of the tile and adds the rows' sums to them. Atomics set bits only. Repeatable: particles
// in stored order, cell by cell. Host: src/soil/particles/particle_to_grid.cpp. Reference:
// tests/soil/reference/reference_solver.cpp.
#include "soil/groups/chunk.h"

static inline LawSoil load_soil(constant SoilRow* row) {
  LawSoil soil;
#define SOIL_CONSTANT(name) soil.name = row->name;
  LAW_CONSTANTS(SOIL_CONSTANT)
  return soil;
}

// Computes law and momentum of the particle in `slot` and stages them at `place`. Returns false
// when a value is not finite.
static inline bool prepare(global float* state, int capacity, int slot, constant SoilRow* soils,
                           float opening, float dt, float dx, float mixing, float most_mixing,
                           float carried, local Chunk* chunk, int place) {
  const int tag = as_int(LOAD(FIELD_TAG));
  constant SoilRow* row = soils + (tag & 0xffff);
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
  chunk->staged[place] = (float4)(p[0], p[1], p[2], mass);
  UNROLL
  for (int k = 0; k < 3; ++k)
    chunk->staged[CHUNK * (1 + k) + place] = (float4)(a[k], a[3 + k], a[6 + k], f[k]);
  chunk->tiles[place] = (uchar)tile_of(tag >> 16);
  // A sum is finite only if each term is.
  const float sum = (x + y + z) + (p[0] + p[1] + p[2]) + (a[0] + a[4] + a[8]) +
                    (soil_state.j + soil_state.j0 + soil_state.shear) +
                    (soil_state.s[3] + soil_state.s[4] + soil_state.s[5]);
  return isfinite(sum);
}

// Computes the mean opening J / J0 of each cell, by mass, 0 where no particle is open (mean_opening
// in soil/point.h), clears the sides of particles in blocks far from shells, and returns bits of
// the tiles that this work-item's particles need. A work-item is a particle, then a cell. All
// work-items must call it; it contains barriers.
static inline int survey_particles(global float* state, int capacity, ParticleBlock particle_block,
                                   local Chunk* chunk, local float* openings) {
  const int me = get_local_id(0);
  float volume = 0.0f, bank = 0.0f;
  bool open = false;
  int wanted = 1;
  for (int begin = 0; begin < particle_block.count; begin += CHUNK) {
    const bool has_particle = begin + me < particle_block.count;
    const int slot = particle_block.start + begin + me;
    int cell = 0;
    if (has_particle) {
      const float mass = convert_float(as_int(LOAD(FIELD_MASS)));
      const int tag = as_int(LOAD(FIELD_TAG));
      cell = cell_of(LOAD(FIELD_X), LOAD(FIELD_X + 1), LOAD(FIELD_X + 2));
      chunk->staged[me].xy = (float2)(mass * LOAD(FIELD_J), mass * LOAD(FIELD_J0));
      if (particle_block.near)
        wanted |= 1 << tile_of(tag >> 16);
      else
        // Far from every shell no particle has a side.
        STORE(FIELD_TAG, as_float(tag & 0xffff));
    }
    mark(chunk, has_particle, cell);
    // The particles of a cell in stored order: from the lowest mark on.
    for (int w = 0; w < MARK_WORDS && me < CELLS; ++w)
      for (uint left = chunk->phase.sort.marks[MARK_WORDS * me + w]; left != 0; left &= left - 1) {
        const float2 one = chunk->staged[32 * w + 31 - (int)clz(left & -left)].xy;
        volume += one.x;
        bank += one.y;
        open |= one.x > one.y;
      }
    barrier(CLK_LOCAL_MEM_FENCE);
  }
  if (me < CELLS) openings[me] = mean_opening(volume, bank, open ? 1.0f : 0.0f);
  return wanted;
}

// Number of nodes of the tile that belong to a work-item.
#define OWN (TILE_SIZE / CHUNK)

// Adds a sorted chunk to the tiles: to `own`, those of this work-item's nodes in tile 0, and to the
// others in memory.
static inline void add_chunk(local Chunk* chunk, int mask, global float4* tiles, float4* own) {
  const int me = get_local_id(0);
  for (int t = 0; mask >> t; ++t) {
    if (!(mask >> t & 1)) continue;
    for (int slab = 0; slab < SLABS; ++slab) {
      if (chunk->first[SLAB_CELLS * slab] == chunk->first[SLAB_CELLS * (slab + 1)]) continue;
      sum_rows(chunk, slab, t, mask != 1);
      barrier(CLK_LOCAL_MEM_FENCE);
      UNROLL
      for (int n = 0; n < OWN; ++n) {
        const float4 more = from_rows(chunk, slab, me + CHUNK * n);
        if (t == 0)
          own[n] += more;
        else
          tiles[t * TILE_NODES + me + CHUNK * n] += more;
      }
      barrier(CLK_LOCAL_MEM_FENCE);
    }
  }
}

__attribute__((reqd_work_group_size(CHUNK, 1, 1))) kernel void particle_to_grid(
    global float* restrict state, const int capacity, constant SoilRow* soils,
    global const ParticleBlock* restrict particle_blocks, global float4* restrict all_tiles,
    global int* restrict used, global Report* restrict report, const float dt, const float dx,
    const float mixing, const float most_mixing, const float carried) {
  local Chunk chunk;
  local float openings[CELLS];
  local int wanted, broken;
  const int block = group_index(), me = get_local_id(0);
  const ParticleBlock particle_block = particle_blocks[block];
  global float4* tiles = all_tiles + (size_t)particle_block.tile * TILE_NODES;
  if (me == 0) wanted = broken = 0;
  barrier(CLK_LOCAL_MEM_FENCE);
  atomic_or(&wanted, survey_particles(state, capacity, particle_block, &chunk, openings));
  barrier(CLK_LOCAL_MEM_FENCE);
  const int mask = wanted;
  float4 own[OWN];
  UNROLL
  for (int n = 0; n < OWN; ++n) {
    own[n] = 0.0f;
    for (int t = 1; mask >> t; ++t) tiles[t * TILE_NODES + me + CHUNK * n] = 0.0f;
  }

  for (int begin = 0; begin < particle_block.count; begin += CHUNK) {
    const bool has_particle = begin + me < particle_block.count;
    const int slot = particle_block.start + begin + me;
    const int cell =
        has_particle ? cell_of(LOAD(FIELD_X), LOAD(FIELD_X + 1), LOAD(FIELD_X + 2)) : 0;
    mark(&chunk, has_particle, cell);
    const int place = place_in_chunk(&chunk, cell);
    if (has_particle && !prepare(state, capacity, slot, soils, openings[cell], dt, dx, mixing,
                                 most_mixing, carried, &chunk, place))
      atomic_or(&broken, 1);
    barrier(CLK_LOCAL_MEM_FENCE);
    add_chunk(&chunk, mask, tiles, own);
  }
  UNROLL
  for (int n = 0; n < OWN; ++n) tiles[me + CHUNK * n] = own[n];
  if (me > 0) return;
  used[block] = mask;
  report[block].broken = broken;
  // Otherwise soil/groups/shell.cl has written them.
  if (!particle_block.near) {
    report[block].push = 0.0f;
    report[block].crossed = 0;
  }
}
