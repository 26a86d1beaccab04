// SPDX-License-Identifier: Apache-2.0
// Gathers node velocities to particles and records their displacement.
//
// In: velocity of field 0 and (near shells) field 1, float4 per node (v [m/s], mass per free volume
// [kg]), BLOCK_NODES per active block; full, filled = such masses that mean packed, and closed;
// closing, spread [s], most [cells]: see point.h; neighbours = 27 active-block indices per block;
// near_slot = index into the near arrays or -1 per active block; node_split = per near node 0 (one
// field) or 1 + own, own = 0 front, 1 back. Out: v, C, moved and J of the particles; Report.speed.
// Parallel: one work-item per block, no shared writes. Repeatable: fixed order of sums.
// Host: src/soil/particles/grid_to_particle.cpp.
#include "soil/lanes/lanes.h"
#include "soil/place.h"
#include "soil/point.h"

// Copies the part of an active block that the tile of a block needs. d = -1, 0, 1: offset of the
// active block.
static inline void copy_part(global const float* block, float* tile, int3 d) {
  const int z0 = d.z < 0 ? 3 : 0, z1 = d.z > 0 ? 3 : 4, y0 = d.y < 0 ? 3 : 0, y1 = d.y > 0 ? 3 : 4;
  for (int z = z0; z < z1; ++z)
    for (int y = y0; y < y1; ++y) {
      global const float* from = block + 4 * (4 * (y + 4 * z));
      float* to = tile + 4 * ((y + 4 * d.y + 1) * 8 + (z + 4 * d.z + 1) * 64);
      if (d.x == 0) vstore16(vload16(0, from), 0, to + 4);
      if (d.x < 0) vstore4(vload4(3, from), 0, to);
      if (d.x > 0) {
        vstore8(vload8(0, from), 0, to + 20);
        vstore4(vload4(2, from), 0, to + 28);
      }
    }
}

// Overwrites split nodes of the tile: the front takes field 0, the back field 1, the neutral tile
// the field of the node's own side. Without a tile for the back (0), only the neutral tile.
static inline void copy_split(global const float* field1, global const int* split, float* neutral,
                              float* back, int3 d) {
  const int z0 = d.z < 0 ? 3 : 0, z1 = d.z > 0 ? 3 : 4, y0 = d.y < 0 ? 3 : 0, y1 = d.y > 0 ? 3 : 4;
  const int x0 = d.x < 0 ? 3 : 0, x1 = d.x > 0 ? 3 : 4;
  for (int z = z0; z < z1; ++z)
    for (int y = y0; y < y1; ++y) {
      const int row = y + 4 * z;
      const int4 any_split = vload4(row, split);
      if (((any_split.x | any_split.y) | (any_split.z | any_split.w)) == 0) continue;
      for (int x = x0; x < x1; ++x) {
        const int n = x + 4 * row,
                  to = (x + 4 * d.x + 1) + 8 * (y + 4 * d.y + 1) + 64 * (z + 4 * d.z + 1);
        if (split[n] == 0) continue;
        if (back) vstore4(vload4(n, field1), to, back);
        if (split[n] == 2) vstore4(vload4(n, field1), to, neutral);
      }
    }
}

INLINED void load_rows(const float* tile, int node, Rows* rows) {
  UNROLL
  for (int k = 0; k < 3; ++k) UNROLL
  for (int j = 0; j < 3; ++j) rows->row[3 * k + j] = vload16(0, tile + 4 * (node + 8 * j + 64 * k));
}

// Computes v and its first moments about the base node of one particle: (v | dx | dy | dz) as
// float4s.
INLINED void gather(const Rows* rows, float4 wx, const float* wy, const float* wz, float4* v,
                    float4* mx, float4* my, float4* mz) {
  float16 sum = 0.0f, sum_y = 0.0f, sum_z = 0.0f;
  const float w0 = wy[0], w1 = wy[16], w2 = wy[32];
  UNROLL
  for (int k = 0; k < 3; ++k) {
    const float16 c = w2 * rows->row[3 * k + 2];
    const float16 bc = fma((float16)(w1), rows->row[3 * k + 1], c);
    const float16 abc = fma((float16)(w0), rows->row[3 * k], bc);
    sum = fma((float16)(wz[16 * k]), abc, sum);
    sum_y = fma((float16)(wz[16 * k]), bc + c, sum_y);
    sum_z = fma((float16)(k * wz[16 * k]), abc, sum_z);
  }
  const float16 w = (float16)(wx.xxxx, wx.yyyy, wx.zzzz, (float4)(0.0f));
  sum *= w;
  sum_y *= w;
  sum_z *= w;
  *v = (sum.lo.lo + sum.lo.hi) + sum.hi.lo;
  *mx = sum.lo.hi + 2.0f * sum.hi.lo;
  *my = (sum_y.lo.lo + sum_y.lo.hi) + sum_y.hi.lo;
  *mz = (sum_z.lo.lo + sum_z.lo.hi) + sum_z.hi.lo;
}

__attribute__((reqd_work_group_size(1, 1, 1))) kernel void grid_to_particle(
    global float* restrict state, const int capacity,
    global const ParticleBlock* restrict particle_blocks, global const int* restrict neighbours,
    global const float* restrict velocity0, global const float* restrict velocity1,
    global const int* restrict near_slot, global const int* restrict node_split,
    global const int* restrict used, global Report* restrict report, const float dt, const float dx,
    const float full, const float filled, const float closing, const float spread,
    const float most) {
  const int block = group_index();
  const ParticleBlock particle_block = particle_blocks[block];
  float tile[3 * TILE_NODES * 4];
  for (int n = 0; n < 27; ++n)
    copy_part(velocity0 + (size_t)neighbours[27 * block + n] * (4 * BLOCK_NODES), tile,
              neighbour_offset(n));
  for (int i = 2048; i < 4 * TILE_NODES; ++i) tile[i] = 0.0f;
  if (particle_block.near) {
    const int mask = used[block];
    for (int t = 1; mask >> t; ++t) {
      if (!(mask >> t & 1)) continue;
      for (int i = 0; i < TILE_NODES / 4; ++i)
        vstore16(vload16(i, tile), i, tile + 4 * TILE_NODES * t);
    }
    float* back = mask & 4 ? tile + 8 * TILE_NODES : 0;
    for (int n = 0; n < 27; ++n) {
      const int near = near_slot[neighbours[27 * block + n]];
      if (near >= 0)
        copy_split(velocity1 + (size_t)near * (4 * BLOCK_NODES), node_split + near * BLOCK_NODES,
                   tile, back, neighbour_offset(n));
    }
  }

  float wxs[64], wy[48], wz[48], parts[4][64];
  int nodes[16];
  Rows rows;
  int cell = -1;
  real fastest = 0.0f;
  for (int slot = particle_block.start; slot < particle_block.start + particle_block.count;
       slot += 16) {
    const int count = min(16, particle_block.start + particle_block.count - slot);
    UNROLL
    for (int f = 0; f < FIELD_S; ++f) SOON(f);
    SOON(FIELD_J);
    SOON(FIELD_J0);
    SOON(FIELD_TAG);
    const real x[3] = {LOAD(FIELD_X), LOAD(FIELD_X + 1), LOAD(FIELD_X + 2)};
    const real bx = base_node(x[0]), by = base_node(x[1]), bz = base_node(x[2]);
    const real f[3] = {x[0] - bx, x[1] - by, x[2] - bz};
    real w[3];
    const real zero = 0.0f;
    spline(f[1], w);
    vstore16(w[0], 0, wy);
    vstore16(w[1], 1, wy);
    vstore16(w[2], 2, wy);
    spline(f[2], w);
    vstore16(w[0], 0, wz);
    vstore16(w[1], 1, wz);
    vstore16(w[2], 2, wz);
    spline(f[0], w);
    TURN(wxs, w[0], w[1], w[2], zero);
    vstore16(tile_node(bx, by, bz) + tile_of(as_int16(LOAD(FIELD_TAG)) >> 16) * TILE_NODES, 0,
             nodes);
    for (int l = 0; l < count; ++l) {
      const int t = turned(l);
      float4 v, mx, my, mz;
      if (nodes[l] != cell) {
        cell = nodes[l];
        load_rows(tile, cell, &rows);
      }
      gather(&rows, vload4(t, wxs), wy + l, wz + l, &v, &mx, &my, &mz);
      vstore4(v, t, parts[0]);
      vstore4(mx, t, parts[1]);
      vstore4(my, t, parts[2]);
      vstore4(mz, t, parts[3]);
    }
    // Lanes without a particle keep their values.
    for (int l = count; l < 16; ++l)
      for (int part = 0; part < 4; ++part) vstore4((float4)(0.0f), turned(l), parts[part]);
    // v, C, and the displacement: dt v, plus a separation where soil is crowded.
    real v[3], m[3], c[9], lean[3], node_mass;
    UNTURN(parts[0], v[0], v[1], v[2], node_mass);
    for (int axis = 0; axis < 3; ++axis) {
      UNTURN(parts[1 + axis], m[0], m[1], m[2], lean[axis]);
      lean[axis] -= f[axis] * node_mass;
      UNROLL
      for (int i = 0; i < 3; ++i) c[3 * i + axis] = velocity_gradient(m[i], f[axis], v[i], dx);
    }
    for (int k = 0; k < 9; ++k) STORE(FIELD_C + k, c[k]);
    for (int axis = 0; axis < 3; ++axis) STORE(FIELD_V + axis, v[axis]);
    const real j = LOAD(FIELD_J), j0 = LOAD(FIELD_J0);
    STORE(FIELD_J, close_noise(j, j0, node_mass, filled, closing));
    const real share = crowding(c, j, j0, node_mass, full, spread);
    UNROLL
    for (int axis = 0; axis < 3; ++axis) {
      const real displacement =
          (dt / dx) * v[axis] + crowding_displacement(share, lean[axis], node_mass, most);
      STORE(FIELD_MOVED + axis, LOAD(FIELD_MOVED + axis) + displacement);
      m[axis] = displacement * (dx / dt);
    }
    fastest = fmax(fastest, fastest_component(m));
  }
  const float8 f8 = fmax(fastest.lo, fastest.hi);
  const float4 f4 = fmax(f8.lo, f8.hi);
  report[block].speed = fmax(fmax(f4.x, f4.y), fmax(f4.z, f4.w));
}

// Ends a transfer: adds the displacement of each particle to its position and clears it.
__attribute__((reqd_work_group_size(1, 1, 1))) kernel void grid_to_particle_end(
    global float* restrict state, const int capacity,
    global const ParticleBlock* restrict particle_blocks) {
  const ParticleBlock particle_block = particle_blocks[group_index()];
  for (int slot = particle_block.start; slot < particle_block.start + particle_block.count;
       slot += 16)
    for (int axis = 0; axis < 3; ++axis) {
      STORE(FIELD_X + axis, LOAD(FIELD_X + axis) + LOAD(FIELD_MOVED + axis));
      STORE(FIELD_MOVED + axis, (real)(0.0f));
    }
}
