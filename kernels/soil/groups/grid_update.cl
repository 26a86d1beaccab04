// SPDX-License-Identifier: Apache-2.0
// Adds up the tiles around each active block and turns momentum into velocity: schedule of
// work-groups.
//
// In, Out: as in soil/lanes/grid_update.cl.
//
// Parallel: one work-group per active block, one node per work-item. Repeatable: tiles are added in
// the order of soil/lanes/grid_update.cl, so that the sum of a node is bit-identical. Host:
// src/soil/particles/grid_update.cpp.
#include "soil/groups/group.h"
#include "soil/node.h"
#include "soil/place.h"

// Returns the node of the tile of neighbour n that lies `up` nodes above this work-item's node, -1:
// none.
static inline int tile_node_above(int n, int up) {
  const int me = get_local_id(0);
  const int3 node = (int3)(me & 3, (me >> 2) & 3, (me >> 4) + up) - 4 * neighbour_offset(n) + 1;
  const bool on =
      node.x >= 0 && node.y >= 0 && node.z >= 0 && node.x < 8 && node.y < 8 && node.z < 8;
  return on ? node.x + 8 * node.y + 64 * node.z : -1;
}

// Returns the node of the tile of neighbour n that lies on this work-item's node, -1: none.
static inline int tile_node(int n) { return tile_node_above(n, 0); }

// Returns v = p / m + dv, added to the velocity before in a held step. Nodes lighter than a mass
// quantum are empty.
static inline float4 velocity_of(float4 momentum, float4 dv, int hold, float4 before) {
  if (!(momentum.w > MASS_QUANTUM)) return (float4)(momentum.xyz * 0.0f, momentum.w);
  float3 v = momentum.xyz * INVERSE_MASS(momentum.w) + dv.xyz;
  if (hold) v += before.xyz;
  return (float4)(v, momentum.w);
}

__attribute__((reqd_work_group_size(BLOCK_NODES, 1, 1))) kernel void grid_update(
    global const int* restrict list, global const int* restrict around,
    global const ParticleBlock* restrict particle_blocks, global const float4* restrict tiles,
    global const int* restrict used, global const BlockFloor* restrict floors,
    global float4* restrict velocity, const float4 dv, const int hold, const int renew) {
  const int block = list[get_group_id(0)], me = get_local_id(0);
  float4 sum = 0.0f;
  float mass_above = 0.0f;
  for (int n = 0; n < 27; ++n) {
    const int particle_block = around[27 * block + n];
    const int node = tile_node(n), above = tile_node_above(n, 1);
    if (particle_block < 0) continue;
    for (int t = 0; used[particle_block] >> t; ++t) {
      if (!(used[particle_block] >> t & 1)) continue;
      const size_t tile = (size_t)(particle_blocks[particle_block].tile + t) * TILE_NODES;
      if (node >= 0) sum += tiles[tile + node];
      if (above >= 0) mass_above += tiles[tile + above].w;
    }
  }
  // Nodes at or below the floor have no velocity, except that the topmost of them lets soil fall
  // that is not on the ground yet; masses become mass per free volume above the ground.
  float4 v = 0.0f;
  if (any(sum != 0.0f)) {
    global const BlockFloor* ground = floors + block;
    const float z = (float)(me >> 4);
    const float4 last = velocity[(size_t)block * BLOCK_NODES + me];
    v = velocity_of(sum, dv, hold, last);
    const float4 below = z - vload4(me & 15, ground->around[0]);
    const float top = ground->held[me & 15];
    if (z <= top) {
      const float falls = z + 1.0f > top ? falling_share(v.w, mass_above, below) : 0.0f;
      v.xyz = (float3)(v.xy * 0.0f, fmin(v.z, 0.0f) * falls);
    }
    v.w = renew ? v.w * (1.0f / free_fraction_above(below)) : last.w;
  }
  velocity[(size_t)block * BLOCK_NODES + me] = v;
}

// Updates blocks near shells, see soil/lanes/grid_update.cl.
__attribute__((reqd_work_group_size(BLOCK_NODES, 1, 1))) kernel void grid_update_near(
    global const int* restrict list, global const int* restrict around,
    global const ParticleBlock* restrict particle_blocks, global const float4* restrict tiles,
    global const int* restrict used, global const float4* restrict block_surface,
    global const int* restrict node_split, global float4* restrict field0,
    global float4* restrict field1, global float4* restrict node_surface,
    global const float4* restrict last0, global const float4* restrict last1, const float4 dv,
    const int hold, const int renew) {
  const int near = get_group_id(0), me = get_local_id(0);
  const int block = list[near];
  float4 neutral = 0.0f, front = 0.0f, back = 0.0f;
  // Where all blocks around have the same surface, as almost everywhere, the node has exactly that.
  float4 surface = 0.0f, first = 0.0f;
  bool mixed = false, found = false;
  for (int n = 0; n < 27; ++n) {
    const int particle_block = around[27 * block + n], node = tile_node(n);
    if (particle_block < 0 || node < 0) continue;
    float mass = 0.0f;
    for (int t = 0; used[particle_block] >> t; ++t) {
      if (!(used[particle_block] >> t & 1)) continue;
      const float4 part =
          tiles[(size_t)(particle_blocks[particle_block].tile + t) * TILE_NODES + node];
      if (t == 0) neutral += part;
      if (t == 1) front += part;
      if (t == 2) back += part;
      mass += part.w;
    }
    const float4 here = block_surface[particle_block];
    if (!found) first = here;
    found = true;
    mixed = mixed || any(here != first);
    surface += here * mass;
  }
  // Neutral soil joins the side of its node; an unsplit node joins all.
  const int near_node = near * BLOCK_NODES + me, split = node_split[near_node];
  const float4 sum = neutral + front + back, none = 0.0f;
  field0[near_node] = velocity_of(split == 0   ? sum
                                  : split == 1 ? front + neutral
                                               : front,
                                  dv, hold, last0[(size_t)block * BLOCK_NODES + me]);
  field1[near_node] = velocity_of(split == 0   ? none
                                  : split == 2 ? back + neutral
                                               : back,
                                  dv, hold, last1[near_node]);
  if (renew) node_surface[near_node] = mixed ? surface / fmax(sum.w, MASS_QUANTUM) : first;
}
