// SPDX-License-Identifier: Apache-2.0
// Updates the stress of each particle, then scatters mass and momentum to the tile of its block.
//
// In: state (field after field, particle_fields.h), soils (one row each), blocks; mixing [s] and
// most_mixing [-]: parameters of advance_state() in point.h; carried = 0 in a held step, whose
// nodes still have their momentum.
//
// Out: tiles, float4 (p_x, p_y, p_z [kg m/s], m [kg]) of the nodes -1..6 around the block; used =
// bits of the tiles written, one int per block; stress, J, J0 and plastic shear of the particles;
// Report.broken.
//
// Parallel: one work-item per block. Repeatable: particles in stored order. Host:
// src/soil/particles/particle_to_grid.cpp. Reference:
// tests/soil/reference/reference_solver.cpp.
#include "soil/lanes/lanes.h"
#include "soil/lanes/opening.h"
#include "soil/point.h"

// Loads the constants of the soils of 16 particles, of which the first `count` exist.
static inline void load_soil(constant SoilRow* soils, int16 tag, int count, LawSoil* soil,
                             real* inv_density) {
  const int first = tag.s0 & 0xffff;
  int kinds[16];
  vstore16(tag & 0xffff, 0, kinds);
  int mixed_soils = 0;
  for (int l = 1; l < count; ++l) mixed_soils |= kinds[l] ^ first;
  if (mixed_soils == 0) {
#define ONE_SOIL(name) soil->name = soils[first].name;
    LAW_CONSTANTS(ONE_SOIL)
    *inv_density = soils[first].inv_density;
    return;
  }
#define LANE_SOIL(name)                                        \
  for (int l = 0; l < 16; ++l) lane[l] = soils[kinds[l]].name; \
  soil->name = vload16(0, lane);
  float lane[16];
  LAW_CONSTANTS(LANE_SOIL)
  for (int l = 0; l < 16; ++l) lane[l] = soils[kinds[l]].inv_density;
  *inv_density = vload16(0, lane);
}

INLINED void flush(global float* tile, int node, const Rows* sums) {
  UNROLL
  for (int k = 0; k < 3; ++k) UNROLL
  for (int j = 0; j < 3; ++j) {
    global float* row = tile + 4 * (node + 8 * j + 64 * k);
    PUT16(vload16(0, row) + sums->row[3 * k + j], row);
  }
}

// Adds the shares of one particle. Its transposed components are momentum at the base node and
// mass, then the change of momentum per node in x, y, z.
INLINED void scatter(Rows* sums, float4 start, float4 ax, float4 ay, float4 az, float4 wx,
                     const float* wyz) {
  const float16 w = (float16)(wx.xxxx, wx.yyyy, wx.zzzz, (float4)(0.0f));
  const float4 next = start + ax;
  const float16 rx = w * (float16)(start, next, next + ax, (float4)(0.0f));
  const float16 ry = w * (float16)(ay, ay, ay, (float4)(0.0f));
  const float16 rz = w * (float16)(az, az, az, (float4)(0.0f));
  UNROLL
  for (int k = 0; k < 3; ++k) {
    float16 row = rx + (float)k * rz;
    UNROLL
    for (int j = 0; j < 3; ++j) {
      sums->row[3 * k + j] = fma((float16)(wyz[16 * (3 * k + j)]), row, sums->row[3 * k + j]);
      row += ry;
    }
  }
}

// Returns the tiles of a block that its particles need: bit 0 always, bits 1 and 2 where particles
// have a side.
static inline int tiles_used(global const float* state, int capacity, int start, int end) {
  // 1 or 2 each, or neither.
  int16 tiles = 0;
  for (int slot = start; slot < end; slot += 16) tiles |= tile_of(as_int16(LOAD(FIELD_TAG)) >> 16);
  return 1 | (some(tiles & 1) ? 2 : 0) | (some(tiles & 2) ? 4 : 0);
}

__attribute__((reqd_work_group_size(1, 1, 1))) kernel void particle_to_grid(
    global float* restrict state, const int capacity, constant SoilRow* soils,
    global const ParticleBlock* restrict particle_blocks, global float* restrict tiles,
    global int* restrict used, global Report* restrict report, const float dt, const float dx,
    const float mixing, const float most_mixing, const float carried) {
  const int block = group_index();
  const ParticleBlock particle_block = particle_blocks[block];
  global float* tile = tiles + (size_t)particle_block.tile * (4 * TILE_NODES);
  const int mask = particle_block.near ? tiles_used(state, capacity, particle_block.start,
                                                    particle_block.start + particle_block.count)
                                       : 1;
  used[block] = mask;
  for (int t = 0; mask >> t; ++t) {
    if (!(mask >> t & 1)) continue;
    for (int i = 0; i < TILE_NODES / 4; ++i)
      PUT16((float16)(0.0f), tile + 4 * TILE_NODES * t + 16 * i);
  }

  float openings[4 * CELLS];
  const bool open = cell_openings(state, capacity, particle_block.start,
                                  particle_block.start + particle_block.count, openings);
  float wxs[4 * 16], wyz[9 * 16], turned_parts[4][64];
  int nodes[16];
  Rows sums;
  int cell = -1;
  int broken = 0;
  for (int slot = particle_block.start; slot < particle_block.start + particle_block.count;
       slot += 16) {
    const int count = min(16, particle_block.start + particle_block.count - slot);
    UNROLL
    for (int f = 0; f < FIELD_ID; ++f) SOON(f);
    int16 tag = as_int16(LOAD(FIELD_TAG));
    // Far from every shell no particle has a side.
    if (!particle_block.near) {
      tag &= 0xffff;
      STORE(FIELD_TAG, as_float16(tag));
    }
    LawSoil soil;
    real inv_density;
    load_soil(soils, tag, count, &soil, &inv_density);

    // Law.
    real c[9], v[3], sigma[6];
    LawState soil_state;
    for (int k = 0; k < 9; ++k) c[k] = LOAD(FIELD_C + k);
    LAW_STATE_FIELDS(LOAD_ONE, LOAD_MANY)
    const real x = LOAD(FIELD_X), y = LOAD(FIELD_X + 1), z = LOAD(FIELD_X + 2);
    real opening = 0.0f;
    if (open) opening = opening_of(openings, cell_of(x, y, z));
    advance_state(c, dt, &soil, opening, mixing, most_mixing, &soil_state, sigma);
    LAW_STATE_FIELDS(STORE_ONE, STORE_MANY)

    // Weights and momentum.
    for (int k = 0; k < 3; ++k) v[k] = LOAD(FIELD_V + k);
    const real bx = base_node(x), by = base_node(y), bz = base_node(z);
    const real f[3] = {x - bx, y - by, z - bz};
    const real mass = convert_float16(as_int16(LOAD(FIELD_MASS))) * MASS_QUANTUM;
    real p[3], a[9];
    affine_momentum(c, sigma, v, f, mass, mass * inv_density, soil_state.j, carried, dt, dx, p, a);

    // A sum is finite only if each term is. Lanes beyond the count hold zeros.
    const real sum = (x + y + z) + (p[0] + p[1] + p[2]) + (a[0] + a[4] + a[8]) +
                     (soil_state.j + soil_state.j0 + soil_state.shear) +
                     (soil_state.s[3] + soil_state.s[4] + soil_state.s[5]);
    broken |= some(!isfinite(sum));

    real w[3], wy[3], wz[3];
    spline(f[1], wy);
    spline(f[2], wz);
    UNROLL
    for (int i = 0; i < 9; ++i) vstore16(wz[i / 3] * wy[i % 3], i, wyz);
    spline(f[0], w);
    const real zero = 0.0f;
    TURN(wxs, w[0], w[1], w[2], zero);
    TURN(turned_parts[0], p[0], p[1], p[2], mass);
    TURN(turned_parts[1], a[0], a[3], a[6], zero);
    TURN(turned_parts[2], a[1], a[4], a[7], zero);
    TURN(turned_parts[3], a[2], a[5], a[8], zero);
    vstore16(tile_node(bx, by, bz) + tile_of(tag >> 16) * TILE_NODES, 0, nodes);
    for (int l = 0; l < count; ++l) {
      const int t = turned(l);
      if (nodes[l] != cell) {
        if (cell >= 0) flush(tile, cell, &sums);
        UNROLL
        for (int i = 0; i < 9; ++i) sums.row[i] = 0.0f;
        cell = nodes[l];
      }
      scatter(&sums, vload4(t, turned_parts[0]), vload4(t, turned_parts[1]),
              vload4(t, turned_parts[2]), vload4(t, turned_parts[3]), vload4(t, wxs), wyz + l);
    }
  }
  if (cell >= 0) flush(tile, cell, &sums);
  report[block].broken = broken ? 1 : 0;
  // Otherwise soil/lanes/shell.cl has written them.
  if (!particle_block.near) {
    report[block].push = 0.0f;
    report[block].crossed = 0;
  }
}
