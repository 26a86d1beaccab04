// SPDX-License-Identifier: Apache-2.0
// Gathers node velocities to particles and records their displacement: schedule of work-groups.
//
// In, Out: as in soil/lanes/grid_to_particle.cl.
//
// Parallel: one work-group per block. It loads the nodes of its tile, then each work-item processes
// one particle after the other. Repeatable: every particle belongs to one work-item; the fastest of
// a block is an integer maximum, which does not depend on order. Host:
// src/soil/particles/grid_to_particle.cpp.
#include "soil/groups/group.h"
#include "soil/point.h"

#define MEMBERS 128

// Returns a node of the particle's own field: split nodes (1 in front, 2 behind) have another
// velocity behind the shell.
static inline float4 side_velocity(local const float4* front, local const float4* back,
                                   local const uchar* split, int node, int side) {
  const bool behind = split[node] != 0 && (side == 2 || (side == 0 && split[node] == 2));
  return behind ? back[node] : front[node];
}

// Computes v and its first moments about the base node over x, y, z.
static inline float4 gather(local const float4* front, local const float4* back,
                            local const uchar* split, int base, int side, const float* wx,
                            const float* wy, const float* wz, float4* mx, float4* my, float4* mz) {
  float4 sum = 0.0f;
  *mx = *my = *mz = (float4)(0.0f);
  UNROLL
  for (int k = 0; k < 3; ++k) UNROLL
  for (int j = 0; j < 3; ++j) {
    const int node = base + 8 * j + 64 * k;
    const float w = wz[k] * wy[j];
    const float4 b = wx[1] * side_velocity(front, back, split, node + 1, side);
    const float4 c = wx[2] * side_velocity(front, back, split, node + 2, side);
    const float4 row = fma((float4)(wx[0]), side_velocity(front, back, split, node, side), b) + c;
    sum = fma((float4)(w), row, sum);
    *mx = fma((float4)(w), fma((float4)(2.0f), c, b), *mx);
    *my = fma((float4)(j * w), row, *my);
    *mz = fma((float4)(k * w), row, *mz);
  }
  return sum;
}

__attribute__((reqd_work_group_size(MEMBERS, 1, 1))) kernel void grid_to_particle(
    global float* restrict state, const int capacity,
    global const ParticleBlock* restrict particle_blocks, global const int* restrict neighbours,
    global const float4* restrict velocity0, global const float4* restrict velocity1,
    global const int* restrict near_slot, global const int* restrict node_split,
    global const int* restrict used, global Report* restrict report, const float dt, const float dx,
    const float full, const float filled, const float closing, const float spread,
    const float most) {
  local float4 front[TILE_SIZE], back[TILE_SIZE];
  local uchar split[TILE_SIZE];
  local int fastest, actives[27], nears[27];
  const int block = group_index(), me = get_local_id(0);
  const ParticleBlock particle_block = particle_blocks[block];
  // The other schedule copies tiles by it; here split nodes choose their field when they are read.
  (void)used;
  if (me == 0) fastest = 0;
  if (me < 27) {
    actives[me] = neighbours[27 * block + me];
    nears[me] = particle_block.near ? near_slot[actives[me]] : -1;
  }
  barrier(CLK_LOCAL_MEM_FENCE);
  UNROLL
  for (int i = me; i < TILE_SIZE; i += MEMBERS) {
    // Tile node -1..6 lies in the block before, this one or the one after.
    const int3 node = (int3)(i & 7, (i >> 3) & 7, i >> 6) - 1;
    const int3 d = (node + 4) / 4 - 1;
    const int3 in_block = node - 4 * d;
    const int n = in_block.x + 4 * in_block.y + 16 * in_block.z;
    const int neighbour = (d.x + 1) + 3 * (d.y + 1) + 9 * (d.z + 1), near = nears[neighbour];
    front[i] = velocity0[(size_t)actives[neighbour] * BLOCK_NODES + n];
    back[i] = (float4)(0.0f);
    split[i] = 0;
    if (near >= 0) {
      split[i] = (uchar)node_split[near * BLOCK_NODES + n];
      back[i] = velocity1[(size_t)near * BLOCK_NODES + n];
    }
  }
  barrier(CLK_LOCAL_MEM_FENCE);

  for (int slot = particle_block.start + me; slot < particle_block.start + particle_block.count;
       slot += MEMBERS) {
    const float x[3] = {LOAD(FIELD_X), LOAD(FIELD_X + 1), LOAD(FIELD_X + 2)};
    const float b[3] = {base_node(x[0]), base_node(x[1]), base_node(x[2])};
    float w[3][3];
    UNROLL
    for (int axis = 0; axis < 3; ++axis) spline(x[axis] - b[axis], w[axis]);
    const int base = (int)b[0] + 1 + 8 * ((int)b[1] + 1) + 64 * ((int)b[2] + 1);
    float4 moments[3];
    const int tile = tile_of(as_int(LOAD(FIELD_TAG)) >> 16);
    const float4 sum = gather(front, back, split, base, tile, w[0], w[1], w[2], &moments[0],
                              &moments[1], &moments[2]);
    const float v[3] = {sum.x, sum.y, sum.z};
    // v, C, and the displacement: dt v, plus a separation where soil is crowded.
    float c[9], speed[3];
    UNROLL
    for (int axis = 0; axis < 3; ++axis) {
      const float m[3] = {moments[axis].x, moments[axis].y, moments[axis].z}, f = x[axis] - b[axis];
      UNROLL
      for (int i = 0; i < 3; ++i) c[3 * i + axis] = velocity_gradient(m[i], f, v[i], dx);
      STORE(FIELD_V + axis, v[axis]);
    }
    UNROLL
    for (int k = 0; k < 9; ++k) STORE(FIELD_C + k, c[k]);
    const float j = LOAD(FIELD_J), j0 = LOAD(FIELD_J0);
    STORE(FIELD_J, close_noise(j, j0, sum.w, filled, closing));
    const float share = crowding(c, j, j0, sum.w, full, spread);
    UNROLL
    for (int axis = 0; axis < 3; ++axis) {
      const float lean = moments[axis].w - (x[axis] - b[axis]) * sum.w;
      const float displacement =
          (dt / dx) * v[axis] + crowding_displacement(share, lean, sum.w, most);
      STORE(FIELD_MOVED + axis, LOAD(FIELD_MOVED + axis) + displacement);
      speed[axis] = displacement * (dx / dt);
    }
    atomic_max_nonnegative(&fastest, fastest_component(speed));
  }
  barrier(CLK_LOCAL_MEM_FENCE);
  if (me == 0) report[block].speed = as_float(fastest);
}

// Ends a transfer, see soil/lanes/grid_to_particle.cl.
__attribute__((reqd_work_group_size(MEMBERS, 1, 1))) kernel void grid_to_particle_end(
    global float* restrict state, const int capacity,
    global const ParticleBlock* restrict particle_blocks) {
  const ParticleBlock particle_block = particle_blocks[group_index()];
  for (int slot = particle_block.start + (int)get_local_id(0);
       slot < particle_block.start + particle_block.count; slot += MEMBERS)
    for (int axis = 0; axis < 3; ++axis) {
      STORE(FIELD_X + axis, LOAD(FIELD_X + axis) + LOAD(FIELD_MOVED + axis));
      STORE(FIELD_MOVED + axis, 0.0f);
    }
}
