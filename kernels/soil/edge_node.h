// SPDX-License-Identifier: Apache-2.0
// Bearing resistance at one node ahead of an edge: strength of the soil around the edge, weight of
// the soil above it, and their pressure. One source for both schedules (lanes and groups).
#ifndef NAVVY_KERNELS_SOIL_EDGE_NODE_H
#define NAVVY_KERNELS_SOIL_EDGE_NODE_H

#include "soil/contact_node.h"
#include "soil/edge_law.h"

// Kernel arguments for the near nodes and what is above and around their blocks.
//
// first, above: active blocks above each near block, from below, in compressed rows. slot: index of
// each active block in the near arrays, or -1. around: 8 indices into `strength` per near block,
// for itself and its lower neighbours, x fastest; -1 where no soil is near an edge. strength: from
// the kernel edge_strength. weight: downward gravity / area of a column [m/s2 / m2].
#define EDGE_ARGS                                                                               \
  global const float4 *restrict before0, global const float4 *restrict before1,                 \
      global const float4 *restrict velocity,                                                   \
      global const int *restrict split, global const int *restrict node_tool,                   \
      global const ContactSoil *restrict surface, global const Tool *restrict tools,            \
      global const NodeEdge *restrict node_edge, global const EdgeProfile *restrict profiles,   \
      global const int *restrict first, global const int *restrict above,                       \
      global const int *restrict slot, global const int *restrict around,                       \
      global const float4 *restrict strength, const float weight, const float dx
// The arguments of EDGE_ARGS, to pass them on.
#define EDGE_SAME                                                                               \
  before0, before1, velocity, split, node_tool, surface, tools, node_edge, profiles, \
      first, above, slot, around, strength, weight, dx

// Returns the mass above the middle of node n of near block `near`, in the column of the node [kg].
static inline float mass_above(int near, int n, global const float4* before0,
                               global const float4* before1, global const float4* velocity,
                               global const int* first, global const int* above,
                               global const int* slot) {
  const int i = near_node(near, n);
  float mass = 0.5f * (before0[i].w + before1[i].w);
  for (int up = n + 16; up < BLOCK_NODES; up += 16)
    mass += before0[near_node(near, up)].w + before1[near_node(near, up)].w;
  for (int k = first[near]; k < first[near + 1]; ++k)
    for (int up = n & 15; up < BLOCK_NODES; up += 16) {
      const int other = slot[above[k]];
      mass += other >= 0
                  ? before0[near_node(other, up)].w + before1[near_node(other, up)].w
                  : velocity[(size_t)above[k] * BLOCK_NODES + up].w;
    }
  return mass;
}

// Returns the mean cohesion [Pa] and sin phi of the soil around the edges at node n of near block
// `near`: sums over the blocks whose particles reach the node.
static inline float2 strength_at(int near, int n, global const int* around,
                                 global const float4* strength) {
  const int3 at = in_block(n);
  float4 sum = (float4)(0.0f);
  for (int z = at.z < 2 ? 0 : 1; z < 2; ++z)
    for (int y = at.y < 2 ? 0 : 1; y < 2; ++y)
      for (int x = at.x < 2 ? 0 : 1; x < 2; ++x) {
        const int entry = around[8 * near + x + 2 * y + 4 * z];
        if (entry >= 0) sum += strength[entry];
      }
  return sum.x > 0.0f ? sum.yz / sum.x : (float2)(0.0f);
}

// Returns the bearing factors of cohesion and overburden for an edge with this profile.
static inline float2 factors_of(global const EdgeProfile* profile, float sin_phi, float friction) {
  const float row = fmin(fmax(sin_phi / EDGE_STEP, 0.0f), EDGE_ANGLES - 1.001f);
  const int k = (int)row;
  const float t = row - (float)k;
  global const float* rows = &profile->at[0].flat_c;
  const float4 low = vload4(k, rows), high = vload4(k + 1, rows);
  const float4 f = low + t * (high - low);
  const float rise = friction * profile->cot;
  return (float2)(edge_factor(f.x, f.z, rise), edge_factor(f.y, f.w, rise));
}

// Returns the outward direction of the edge at node n of near block `near`, and the largest
// pressure of the soil on it times the area that the node stands for [Pa cell faces]; zero at nodes
// that are not ahead of an edge.
static inline float4 edge_node(int near, int n, EDGE_ARGS) {
  const int i = near_node(near, n);
  const NodeEdge edge = node_edge[i];
  if (edge.tag == 0 || split[i] != 0 || node_tool[i] != ((edge.tag - 1) & 0xffff))
    return (float4)(0.0f);
  const float mass = before0[i].w;
  const float3 outward = vload3(0, edge.outward);
  const float area = sqrt(dot(outward, outward));
  if (!(mass > MASS_QUANTUM && area > 0.0f)) return (float4)(0.0f);
  const float2 soil = strength_at(near, n, around, strength);
  const float2 factor = factors_of(profiles + ((edge.tag - 1) >> 16), soil.y,
                                   surface[i].friction * tools[node_tool[i]].friction);
  // The node stands for a place ahead of the edge, which may be lower or higher.
  const float higher = -SCHEME(edge_ahead) * outward.z / area;
  const float load =
      weight * fmax(mass_above(near, n, before0, before1, velocity, first, above, slot) -
                        higher * mass, 0.0f);
  const float pressure =
      edge_pressure(soil.x, load, factor.x, factor.y);
  const float fill = mass * surface[i].inv_density / (dx * dx * dx);
  return (float4)(outward / area, area * pressure * contact_unit(SCHEME(contact_full) * fill));
}

#endif  // NAVVY_KERNELS_SOIL_EDGE_NODE_H
