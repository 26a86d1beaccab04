// SPDX-License-Identifier: Apache-2.0
// Adds up the tiles around each active block and turns momentum into velocity.
//
// In: tiles of the blocks, used = bits of those written; around = 27 block indices per active block
// (-1: no particles there); floors = resting ground per active block; hold = 1 in a held step:
// nodes add the impulse of the step to their velocity; renew = 0: masses per free volume are those
// of the step before.
//
// Out: float4 (v [m/s] after gravity, m [kg]) per node; 0 where there is no mass. Far from shells,
// m is divided by the fraction of the node's kernel that lies above the ground (soil/node.h).
//
// Parallel: one work-item per active block. Repeatable: neighbours in fixed order. Host:
// src/soil/particles/grid_update.cpp.
#include "soil/lanes/node_rows.h"
#include "soil/place.h"

// Adds the layers z0 .. z1 - 1 of nodes of a neighbour's tile; d: offset of the neighbour. rows: a
// float16 per row of four nodes, from layer z on.
static inline void add_layers(global const float* tile, float16* rows, int3 d, int z, int z0,
                              int z1) {
  const int y0 = d.y > 0 ? 3 : 0, y1 = d.y < 0 ? 3 : 4;
  for (int k = z0; k < z1; ++k)
    for (int y = y0; y < y1; ++y) {
      global const float* from = tile + 4 * ((y - 4 * d.y + 1) * 8 + (k - 4 * d.z + 1) * 64);
      float16* row = rows + y + 4 * (k - z);
      if (d.x == 0) *row += vload16(0, from + 4);
      if (d.x > 0) row->hi.hi += vload4(0, from);
      if (d.x < 0) {
        float16 part = vload16(0, from + 20);
        part.hi.hi = 0.0f;
        *row += part;
      }
    }
}

// Adds the part of a neighbour's tile that lies on this block.
static inline void add_part(global const float* tile, float16* rows, int3 d) {
  add_layers(tile, rows, d, 0, d.z > 0 ? 3 : 0, d.z < 0 ? 3 : 4);
}

__attribute__((reqd_work_group_size(1, 1, 1))) kernel void grid_update(
    global const int* restrict list, global const int* restrict around,
    global const ParticleBlock* restrict particle_blocks, global const float* restrict tiles,
    global const int* restrict used, global const BlockFloor* restrict floors,
    global float* restrict velocity, const float4 dv, const int hold, const int renew) {
  const int block = list[group_index()];
  float16 rows[16];
  for (int i = 0; i < 16; ++i) rows[i] = 0.0f;
  for (int n = 0; n < 27; ++n) {
    const int particle_block = around[27 * block + n];
    if (particle_block < 0) continue;
    for (int t = 0; used[particle_block] >> t; ++t)
      if (used[particle_block] >> t & 1)
        add_part(tiles + (size_t)(particle_blocks[particle_block].tile + t) * (4 * TILE_NODES),
                 rows, neighbour_offset(n));
  }
  global float* out = velocity + (size_t)block * (4 * BLOCK_NODES);
  global const BlockFloor* ground = floors + block;
  const bool in_the_open = far_above(ground);
  float16 above[4];
  for (int y = 0; y < 4; ++y) above[y] = 0.0f;
  // Only below the topmost held nodes of the uppermost layer.
  const float16 top = vload16(0, ground->held);
  const bool needs_above = !in_the_open && some(top >= 3.0f & top < 4.0f);
  for (int n = 9; n < 27 && needs_above; ++n) {
    const int particle_block = around[27 * block + n];
    if (particle_block < 0) continue;
    for (int t = 0; used[particle_block] >> t; ++t)
      if (used[particle_block] >> t & 1)
        add_layers(tiles + (size_t)(particle_blocks[particle_block].tile + t) * (4 * TILE_NODES),
                   above, neighbour_offset(n), 4, 4, 5);
  }
  for (int i = 0; i < 16; ++i) {
    if (!some(rows[i] != 0.0f)) {
      PUT16((float16)(0.0f), out + 16 * i);
      continue;
    }
    const float16 last = vload16(0, out + 16 * i);
    const float16 v = velocity_of(rows[i], dv, hold, out + 16 * i);
    const float16 next = i < 12 ? rows[i + 4] : above[i - 12];
    PUT16(in_the_open ? v : held(v, next.s37bf, last, renew, ground, i), out + 16 * i);
  }
}

// Updates blocks near shells. Split nodes keep a front (field 0) and a back (field 1) velocity
// [Bardenhagen 2000], neither of them held yet [docs/tools.md, two nodal fields].
//
// node_split per near node: 0 one field, 1 split and in front, 2 split and behind. block_surface =
// a ContactSoil per block; node_surface = its mean by mass at the node, kept if renew is 0. last0
// (per active block) and last1 = both fields after contact in the previous step.
__attribute__((reqd_work_group_size(1, 1, 1))) kernel void grid_update_near(
    global const int* restrict list, global const int* restrict around,
    global const ParticleBlock* restrict particle_blocks, global const float* restrict tiles,
    global const int* restrict used, global const float4* restrict block_surface,
    global const int* restrict node_split, global float* restrict field0,
    global float* restrict field1, global float4* restrict node_surface,
    global const float* restrict last0, global const float* restrict last1, const float4 dv,
    const int hold, const int renew) {
  const int near = group_index();
  const int block = list[near];
  float16 rows[3][16], total[16];
  float4 weight[64];
  for (int i = 0; i < 16; ++i) rows[0][i] = rows[1][i] = rows[2][i] = total[i] = 0.0f;
  // Where all blocks around have the same surface, as almost everywhere, no mean is needed.
  float4 first = (float4)(0.0f);
  bool mixed = false, any_block = false;
  for (int n = 0; n < 27 && renew; ++n) {
    const int particle_block = around[27 * block + n];
    if (particle_block < 0) continue;
    if (!any_block) first = block_surface[particle_block];
    any_block = true;
    mixed = mixed || any(block_surface[particle_block] != first);
  }
  if (mixed)
    for (int i = 0; i < 64; ++i) weight[i] = (float4)(0.0f);
  for (int n = 0; n < 27; ++n) {
    const int particle_block = around[27 * block + n];
    if (particle_block < 0) continue;
    for (int i = 0; i < 16 && mixed; ++i) total[i] = 0.0f;
    for (int t = 0; used[particle_block] >> t; ++t) {
      if (!(used[particle_block] >> t & 1)) continue;
      global const float* tile =
          tiles + (size_t)(particle_blocks[particle_block].tile + t) * (4 * TILE_NODES);
      add_part(tile, rows[t], neighbour_offset(n));
      if (mixed) add_part(tile, total, neighbour_offset(n));
    }
    if (!mixed) continue;
    const float4 here = block_surface[particle_block];
    for (int i = 0; i < 16; ++i) {
      const float4 m = total[i].s37bf;
      weight[4 * i] += here * m.x;
      weight[4 * i + 1] += here * m.y;
      weight[4 * i + 2] += here * m.z;
      weight[4 * i + 3] += here * m.w;
    }
  }
  global const float* from0 = last0 + (size_t)block * (4 * BLOCK_NODES);
  global const float* from1 = last1 + (size_t)near * (4 * BLOCK_NODES);
  global float* out0 = field0 + (size_t)near * (4 * BLOCK_NODES);
  global float* out1 = field1 + (size_t)near * (4 * BLOCK_NODES);
  for (int i = 0; i < 16; ++i) {
    // Neutral soil joins the side of its node; an unsplit node joins all.
    const int4 split = vload4(i, node_split + near * BLOCK_NODES);
    const int16 s = (int16)(split.xxxx, split.yyyy, split.zzzz, split.wwww);
    const float16 none = 0.0f;
    const float16 sum = rows[0][i] + rows[1][i] + rows[2][i];
    const float16 front = rows[1][i] + select(none, rows[0][i], s == 1);
    const float16 back = rows[2][i] + select(none, rows[0][i], s == 2);
    PUT16(velocity_of(select(sum, front, s > 0), dv, hold, from0 + 16 * i), out0 + 16 * i);
    PUT16(velocity_of(select(none, back, s > 0), dv, hold, from1 + 16 * i), out1 + 16 * i);
    if (!renew) continue;
    const float4 m = fmax(sum.s37bf, MASS_QUANTUM);
    global float4* out = node_surface + near * BLOCK_NODES + 4 * i;
    out[0] = mixed ? weight[4 * i] / m.x : first;
    out[1] = mixed ? weight[4 * i + 1] / m.y : first;
    out[2] = mixed ? weight[4 * i + 2] / m.z : first;
    out[3] = mixed ? weight[4 * i + 3] / m.w : first;
  }
}
