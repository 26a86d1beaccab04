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

// The particle blocks around an active one, in local memory: bits of the tiles that each has, 0
// where there is none, and its first tile.
typedef struct Around {
  int used[27], tile[27];
} Around;

// Loads all neighbours of active block `block` at once: each takes a chain of dependent loads. All
// work-items must call it; it ends with a barrier.
static inline void load_around(local Around* here, int block, global const int* around,
                               global const ParticleBlock* particle_blocks,
                               global const int* used) {
  const int me = get_local_id(0);
  if (me < 27) {
    const int particle_block = around[27 * block + me];
    here->used[me] = particle_block < 0 ? 0 : used[particle_block];
    here->tile[me] = particle_block < 0 ? 0 : particle_blocks[particle_block].tile;
  }
  barrier(CLK_LOCAL_MEM_FENCE);
}

// The tiles that overlap a node are those of two neighbours along each axis: along x, those at
// first.x and first.x + 1, where the node of the tile is node.x and node.x - 4.
typedef struct Overlap {
  int3 first, node;
} Overlap;

// Returns the tiles that overlap this work-item's node, or the one `up` nodes above it.
static inline Overlap overlap(int up) {
  const int me = get_local_id(0);
  const int3 node = (int3)(me & 3, (me >> 2) & 3, (me >> 4) + up);
  Overlap out;
  // Nodes -1 .. 2 lie in the tile of the neighbour before, too, nodes 3 .. 6 in that of the next.
  out.first = select((int3)(-1), (int3)(0), node > 2);
  out.node = node + 1 - 4 * out.first;
  return out;
}

// Returns neighbour `corner` (0 .. 7, x fastest) of the eight whose tiles overlap a node: in
// ascending order of neighbours, as in the other schedule. node: its node in that tile.
static inline int neighbour_of(Overlap at, int corner, int* node) {
  const int3 d = (int3)(corner & 1, corner >> 1 & 1, corner >> 2);
  const int3 n = at.first + d + 1, in_tile = at.node - 4 * d;
  *node = in_tile.x + 8 * in_tile.y + 64 * in_tile.z;
  return n.x + 3 * n.y + 9 * n.z;
}

// Returns v = p / m + dv, added to the velocity before in a held step. Nodes lighter than a mass
// quantum are empty.
static inline float4 velocity_of(float4 momentum, float4 dv, int hold, float4 before) {
  if (!(momentum.w > MASS_QUANTUM)) return (float4)(momentum.xyz * 0.0f, momentum.w);
  float3 v = momentum.xyz * INVERSE_MASS(momentum.w) + dv.xyz;
  if (hold) v += before.xyz;
  return (float4)(v, momentum.w);
}

// Returns what tile t of neighbour n gives to its node `node`.
static inline float4 tile_part(local const Around* here, int n, int t, int node,
                               global const float4* tiles) {
  float4 part = 0.0f;
  if (here->used[n] >> t & 1) part = tiles[(size_t)(here->tile[n] + t) * TILE_NODES + node];
  return part;
}

// Returns what all tiles give to a node.
static inline float4 sum_of_tiles(local const Around* here, Overlap at,
                                  global const float4* tiles) {
  float4 sum = 0.0f;
  // No UNROLL: PoCL 3.1 then computes zeros (kernels/README.md).
  for (int corner = 0; corner < 8; ++corner) {
    int node;
    const int n = neighbour_of(at, corner, &node);
    for (int t = 0; t < 3; ++t) sum += tile_part(here, n, t, node, tiles);
  }
  return sum;
}

__attribute__((reqd_work_group_size(BLOCK_NODES, 1, 1))) kernel void grid_update(
    global const int* restrict list, global const int* restrict around,
    global const ParticleBlock* restrict particle_blocks, global const float4* restrict tiles,
    global const int* restrict used, global const BlockFloor* restrict floors,
    global float4* restrict velocity, const float4 dv, const int hold, const int renew) {
  local Around here;
  const int block = list[group_index()], me = get_local_id(0);
  load_around(&here, block, around, particle_blocks, used);
  const float4 sum = sum_of_tiles(&here, overlap(0), tiles);
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
      float falls = 0.0f;
      if (z + 1.0f > top)
        falls = falling_share(v.w, sum_of_tiles(&here, overlap(1), tiles).w, below);
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
  local Around here;
  local float4 surfaces[27];
  const int near = group_index(), me = get_local_id(0);
  const int block = list[near];
  // The barrier in load_around publishes it.
  if (me < 27) surfaces[me] = block_surface[max(around[27 * block + me], 0)];
  load_around(&here, block, around, particle_blocks, used);
  const Overlap at = overlap(0);
  float4 neutral = 0.0f, front = 0.0f, back = 0.0f;
  // Where all blocks around have the same surface, as almost everywhere, the node has exactly that.
  float4 surface = 0.0f, first = 0.0f;
  bool mixed = false, found = false;
  // No UNROLL: PoCL 3.1 then computes zeros (kernels/README.md).
  for (int corner = 0; corner < 8; ++corner) {
    int node;
    const int n = neighbour_of(at, corner, &node);
    if (here.used[n] == 0) continue;
    const float4 of_neutral = tile_part(&here, n, 0, node, tiles),
                 of_front = tile_part(&here, n, 1, node, tiles),
                 of_back = tile_part(&here, n, 2, node, tiles);
    neutral += of_neutral;
    front += of_front;
    back += of_back;
    const float mass = of_neutral.w + of_front.w + of_back.w;
    const float4 here_surface = surfaces[n];
    if (!found) first = here_surface;
    found = true;
    mixed = mixed || any(here_surface != first);
    surface += here_surface * mass;
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
