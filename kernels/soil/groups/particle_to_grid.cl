// SPDX-License-Identifier: Apache-2.0
// Stress update of each particle, then scatter of mass and momentum to its block's tile: schedule of work-groups.
//
// In, Out: as in soil/particle_to_grid.cl, tiles without their pad.
// One work-group per home block. A work-item is first one particle of a chunk (law), then one cell of base nodes: it
// adds up the cell's particles for three layers of nodes in turn, and gives the nine nodes of a layer to the tile one
// offset after the other. Cells of one offset share no node, so nothing is atomic. Particles are taken in stored order,
// cell by cell: sums repeat bit for bit. Host: src/soil/particles/transfer.cpp. Reference:
// src/soil/reference/reference_solver.cpp.
#include "soil/groups/chunk.h"
#include "soil/law.h"

static inline LawSoil load_soil(constant float* at) {
  const LawSoil soil = {
      at[SOIL_BULK],        at[SOIL_SHEAR],       at[SOIL_ALPHA],     at[SOIL_K_RESIDUAL], at[SOIL_K_BOND],
      at[SOIL_INV_REMOULD], at[SOIL_INV_OPENING], at[SOIL_VISCOSITY], at[SOIL_SWELL],      at[SOIL_LOOSENING],
#ifdef LAW_EXTENDED
      at[SOIL_DILATANCY],   at[SOIL_INV_RANGE],   at[SOIL_MATCHED],   at[SOIL_ALPHA_FAST], at[SOIL_GRAIN],
      at[SOIL_INERTIAL],    at[SOIL_CAP],         at[SOIL_CAP_GROWTH],
#endif
  };
  return soil;
}

// Law and affine momentum of the particle in slot `at`; false when a value is not finite. out: STAGED words.
static inline bool prepare(global float* state, int capacity, int at, constant float* soils, float opening, float dt,
                           float dx, float mixing, float* out) {
  const int tag = as_int(LOAD(FIELD_TAG));
  constant float* row = soils + SOIL_WORDS * (tag & 0xffff);
  const LawSoil soil = load_soil(row);
  float c[9], s[6], sigma[6];
  UNROLL
  for (int k = 0; k < 9; ++k) c[k] = LOAD(FIELD_C + k);
  UNROLL
  for (int k = 0; k < 6; ++k) s[k] = LOAD(FIELD_S + k);
  float j = LOAD(FIELD_J), j0 = LOAD(FIELD_J0), shear = LOAD(FIELD_SHEAR);
  const bool lost = !isfinite(j);  // the law's floor would hide it
  if (opening > 0.0f) j += mixing * (j0 * opening - j);
  law_update(c, dt, &soil, s, &j, &j0, &shear, sigma);
  if (lost) j = NAN;
  UNROLL
  for (int k = 0; k < 6; ++k) STORE(FIELD_S + k, s[k]);
  STORE(FIELD_J, j);
  STORE(FIELD_J0, j0);
  STORE(FIELD_SHEAR, shear);

  // The affine momentum field A = (m C dx - dt 4/dx V sigma) per node step.
  const float x = LOAD(FIELD_X), y = LOAD(FIELD_X + 1), z = LOAD(FIELD_X + 2);
  const float fx = x - base_node(x), fy = y - base_node(y), fz = z - base_node(z);
  const float mass = convert_float(as_int(LOAD(FIELD_MASS))) * MASS_QUANTUM;
  const float cm = mass * dx, sv = (4.0f * dt / dx) * (mass * row[SOIL_INV_DENSITY]) * j;
  const float a[9] = {cm * c[0] - sv * sigma[0], cm * c[1] - sv * sigma[3], cm * c[2] - sv * sigma[5],
                      cm * c[3] - sv * sigma[3], cm * c[4] - sv * sigma[1], cm * c[5] - sv * sigma[4],
                      cm * c[6] - sv * sigma[5], cm * c[7] - sv * sigma[4], cm * c[8] - sv * sigma[2]};
  UNROLL
  for (int i = 0; i < 3; ++i) {
    out[STAGED_P + i] = mass * LOAD(FIELD_V + i) - (a[3 * i] * fx + a[3 * i + 1] * fy + a[3 * i + 2] * fz);
    UNROLL
    for (int k = 0; k < 3; ++k) out[STAGED_A + 3 * k + i] = a[3 * i + k];
  }
  out[STAGED_MASS] = mass;
  out[STAGED_F] = fx;
  out[STAGED_F + 1] = fy;
  out[STAGED_F + 2] = fz;
  // A sum is finite only if each term is.
  const float sum = (x + y + z) + (out[STAGED_P] + out[STAGED_P + 1] + out[STAGED_P + 2]) + (a[0] + a[4] + a[8]) +
                    (j + j0 + shear) + (s[3] + s[4] + s[5]);
  return isfinite(sum);
}

// Mean opening of the cells of a home: J / J0 by mass, 0 where no particle is open (soil/opening.h). A work-item is a
// cell.
static inline float cell_opening(global const float* state, int capacity, int4 home, local int* cells,
                                 local float* stage) {
  const int me = get_local_id(0);
  float volume = 0.0f, bank = 0.0f;
  bool open = false;
  for (int begin = 0; begin < home.y; begin += CHUNK) {
    const int count = min(CHUNK, home.y - begin);
    const int at = home.x + begin + me;
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
  return open ? volume / fmax(bank, 1.0f) : 0.0f;
}

// What a home needs: bit 0 always, 1 and 2 for the tiles of a shell's sides, 3 when any particle is open.
static inline int needs(global float* state, int capacity, int4 home) {
  int out = 1;
  for (int i = get_local_id(0); i < home.y; i += CELLS) {
    const int at = home.x + i, tag = as_int(LOAD(FIELD_TAG));
    out |= LOAD(FIELD_J) > LOAD(FIELD_J0) ? 8 : 0;
    if (home.w)
      out |= 1 << tile_of(tag);
    else
      STORE(FIELD_TAG, as_float(tag & 0xffff));  // far from every shell nobody has a side
  }
  return out;
}

__attribute__((reqd_work_group_size(CELLS, 1, 1))) kernel void particle_to_grid(
    global float* restrict state, const int capacity, constant float* soils, global const int4* restrict homes,
    global float4* restrict tiles, global int* restrict used, global float* restrict report, const float dt,
    const float dx, const float mixing) {
  local float4 tile[TILE_SIZE];
  local float stage[STAGED * CHUNK];
  local int cells[CHUNK], sides[CHUNK], first[CELLS], counts[CELLS];
  local float openings[CELLS];
  local int wanted, broken;
  const int block = get_group_id(0), me = get_local_id(0);
  const int4 home = homes[block];  // start, count, first tile, near
  if (me == 0) wanted = broken = 0;
  barrier(CLK_LOCAL_MEM_FENCE);
  atomic_or(&wanted, needs(state, capacity, home));
  for (int i = me; i < TILE_SIZE; i += CELLS) tile[i] = (float4)(0.0f);
  openings[me] = 0.0f;
  barrier(CLK_LOCAL_MEM_FENCE | CLK_GLOBAL_MEM_FENCE);
  const int mask = wanted & 7;
  for (int t = 1; mask >> t; ++t)
    for (int i = me; i < TILE_SIZE; i += CELLS) tiles[(size_t)(home.z + t) * TILE_NODES + i] = (float4)(0.0f);
  if (wanted & 8) openings[me] = cell_opening(state, capacity, home, cells, stage);
  barrier(CLK_LOCAL_MEM_FENCE | CLK_GLOBAL_MEM_FENCE);

  for (int begin = 0; begin < home.y; begin += CHUNK) {
    const int count = min(CHUNK, home.y - begin);
    float mine[STAGED];
    int cell = 0, side = 0;
    first[me] = counts[me] = 0;
    if (me < count) {
      const int at = home.x + begin + me;
      cell = cell_of(LOAD(FIELD_X), LOAD(FIELD_X + 1), LOAD(FIELD_X + 2));
      side = tile_of(as_int(LOAD(FIELD_TAG)));
      if (!prepare(state, capacity, at, soils, openings[cell], dt, dx, mixing, mine)) atomic_or(&broken, 1);
      cells[me] = cell;
    }
    barrier(CLK_LOCAL_MEM_FENCE);
    if (me < count) {
      const int slot = place_in_chunk(cells, count, cell, first, counts);
      sides[slot] = side;
      UNROLL
      for (int f = 0; f < STAGED; ++f) stage[f * CHUNK + slot] = mine[f];
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
                tiles[(size_t)(home.z + t) * TILE_NODES + node] += sums[o];
            }
            barrier(CLK_LOCAL_MEM_FENCE | CLK_GLOBAL_MEM_FENCE);
          }
        }
  }
  for (int i = me; i < TILE_SIZE; i += CELLS) tiles[(size_t)home.z * TILE_NODES + i] = tile[i];
  if (me > 0) return;
  used[block] = mask;
  report[REPORT_WORDS * block + REPORT_BAD] = broken ? 1.0f : 0.0f;
  if (!home.w) report[REPORT_WORDS * block + REPORT_PUSH] = report[REPORT_WORDS * block + REPORT_CROSSED] = 0.0f;
}
