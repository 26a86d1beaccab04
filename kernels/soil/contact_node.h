// SPDX-License-Identifier: Apache-2.0
// Contact of one node with a tool, and the small linear system for the twist of a tool that yields
// to the soil. One source for both schedules (lanes and groups).
#ifndef NAVVY_KERNELS_SOIL_CONTACT_NODE_H
#define NAVVY_KERNELS_SOIL_CONTACT_NODE_H

#include "soil/scalar.h"
#include "soil/contact_law.h"
#include "soil/node.h"

// Returns the index of node n (0 .. 63) of near block `near` in the arrays of near nodes.
static inline int near_node(int near, int n) { return near * BLOCK_NODES + n; }
// Returns the offset of node n (0 .. 63) from the lower corner of its block [cells].
static inline int3 in_block(int n) { return (int3)(n & 3, (n >> 2) & 3, n >> 4); }

// Loads the contact data of field s (0 front, 1 back) of one near node into `node`: everything that
// its impulse depends on except the tool's twist. Returns false, with `node` incomplete, if the
// node has no contact.
//
// i: index of the node in the near arrays. place: coordinates of the node in G. dx: edge of a cell
// [m]. field: velocities [m/s] and masses [kg] of field s. edge: from the kernel edge_nodes. only:
// index of the only tool to consider, -1 for all tools. The other pointers are the near arrays of
// NearNodes and ShellQuery.
static inline bool load_node(ContactNode* node, int s, int i, int3 place, float dx, Reach reach,
                             global const float4* field, global const int* split,
                             global const int* node_tool, global const NodeShell* shell,
                             global const ContactSoil* surface, global const float4* edge,
                             global const Tool* tools, int only) {
  // Nodes with one field are ahead of an edge, or have no contact.
  if (split[i] == 0 && (s != 0 || !(edge[i].w > 0.0f))) return false;
  const float4 v = field[i];
  if (!(v.w > MASS_QUANTUM)) return false;
  global const Tool* tool = tools + node_tool[i];
  if (tool->active == 0 || (only >= 0 && only != node_tool[i])) return false;
  // Lever arm from the tool's origin [m]. Both points are relative to the window corner, so that no
  // digits are lost far from the site's origin.
  node->r = dx * (convert_float3(place - 4 * vload3(0, tool->window)) - vload3(0, tool->origin));
  node->v = v.xyz;
  node->m = v.w;
  node->edge = 0.0f;
  if (split[i] == 0) {
    node->n = edge[i].xyz;
    node->edge = edge[i].w * reach.patch;
    node->slow = reach.slow;
    return true;
  }
  // Both fields use the distance to the plate's middle surface: the back field sees it mirrored.
  const float sign = s == 0 ? 1.0f : -1.0f;
  const float clearance = sign * shell[i].distance - tool->half_thickness, inset = shell[i].inset;
  node->share = contact_share(clearance, inset, &reach);
  if (!(node->share > 0.0f)) return false;
  node->n = sign * vload3(0, shell[i].normal);
  node->mu = surface[i].friction * tool->friction;
  const float free_fraction =
      fmax(mean_of(kernel_share((float4)(clearance))), SCHEME(min_free_fraction));
  // Soil at the node / soil that would fill the free part of its kernel in the bank [-].
  const float fill = v.w * surface[i].inv_density / (dx * dx * dx * free_fraction);
  const float3 down = (float3)(reach.down_x, reach.down_y, reach.down_z);
  node->settling = contact_settling(clearance, fill, dot(node->n, down), &reach);
  // Adhesion is an impulse per step: stress x area x dt, as contact_stick returns it.
  node->stick = 0.0f;
  if (surface[i].adhesion > 0.0f) {
    const float adhesion = surface[i].adhesion * tool->adhesion * contact_touch(fill);
    node->stick = contact_stick(adhesion, contact_area(clearance, inset, &reach), &reach);
  }
  return true;
}

// Kernel arguments for the near blocks: their active-block indices, and the key of each active
// block.
#define BLOCK_ARGS global const int* restrict near_list, global const int4* restrict keys
// Arguments of functions that load near nodes: the near arrays, the tools, and the parameters of
// load_node.
#define NODE_ARGS                                                                         \
  global const float4 *restrict before0, global const float4 *restrict before1,           \
      global const int *restrict split, global const int *restrict node_tool,             \
      global const NodeShell *restrict shell, global const ContactSoil *restrict surface, \
      global const float4 *restrict edge, global const Tool *restrict tools, const int only,  \
      const Reach reach, const float dx
// The arguments of NODE_ARGS, to pass them on.
#define NODE_SAME before0, before1, split, node_tool, shell, surface, edge, tools, only, reach, dx
// Calls load_node for field s of node n in block `key`, with the arguments of NODE_ARGS.
#define LOAD_NODE(node)                                                                      \
  load_node(node, s, i, 4 * key + in_block(n), dx, reach, s == 0 ? before0 : before1, split, \
            node_tool, shell, surface, edge, tools, only)

// Initial value of a ContactSums.
#define NO_SUMS \
  { {0.0f}, {0.0f}, 0.0f }

// Adds the contribution of field s of node n in near block `near` (with block coordinates `key`) to
// the sums for the tool `only`. The contribution consists of the wrench of the node's impulse J
// (moment about the tool's origin, force), and of the stiffness matrix G^T m P G. m is the node's
// mass, G maps the tool's twist to the plate's velocity at the node, and P is the part of that
// velocity which the contact transfers to the node: its share along the normal, and all of the slip
// if the contact sticks [docs/tools.md, two-way solve].
static inline void add_sums(ContactSums* sums, int s, int near, int n, int3 key, NODE_ARGS) {
  const int i = near_node(near, n);
  ContactNode node;
  if (!LOAD_NODE(&node)) return;
  global const Tool* tool = tools + node_tool[i];
  ContactBranch branch;
  const float3 j = contact_impulse(&node, vload3(0, tool->twist), vload3(1, tool->twist),
                                   reach.opening, &branch);
  if (!branch.acts) return;
  // The sums are of impulses on soil; the tool gets the opposite ones.
  const float3 l = cross(node.r, j);
  sums->wrench[0] += l.x;
  sums->wrench[1] += l.y;
  sums->wrench[2] += l.z;
  sums->wrench[3] += j.x;
  sums->wrench[4] += j.y;
  sums->wrench[5] += j.z;
  // Three axes when the contact sticks, which also cover the normal, and a correction along the
  // normal. Each adds m p g g^T with g = (r x d, d) and the part p that is passed on.
  const float along_normal =
      (branch.pushing ? branch.held : 0.0f) - (branch.sticking ? 1.0f : 0.0f);
  for (int a = branch.sticking ? 0 : 3; a < 4; ++a) {
    if (a == 3 && along_normal == 0.0f) continue;
    const float3 d = a == 3 ? node.n : (float3)(a == 0, a == 1, a == 2);
    const float held = node.m * (a == 3 ? along_normal : 1.0f);
    const float3 moment = cross(node.r, d);
    const float g[6] = {moment.x, moment.y, moment.z, d.x, d.y, d.z};
    int k = 0;
    for (int row = 0; row < 6; ++row)
      for (int col = row; col < 6; ++col) sums->stiffness[k++] += held * g[row] * g[col];
  }
}

// Runs one Newton iteration for the twist V of a tool: solves F(V) = V - V_start + W sum J(V) = 0
// with the derivative 1 + W K. W is the inverse mass of the tool; sum J and K are the wrench and
// stiffness in `total`.
static inline void solve_twist(global Tool* tool, const ContactSums* total) {
  // Augmented matrix of the system; the sums hold the upper triangle of K only.
  float a[6][7], stiff[6][6];
  for (int i = 0, k = 0; i < 6; ++i)
    for (int j = i; j < 6; ++j) stiff[i][j] = stiff[j][i] = total->stiffness[k++];
  for (int i = 0; i < 6; ++i) {
    a[i][6] = tool->twist[i] - tool->start[i];
    for (int j = 0; j < 6; ++j) {
      a[i][j] = i == j ? 1.0f : 0.0f;
      a[i][6] += tool->inverse_mass[6 * i + j] * total->wrench[j];
      for (int k = 0; k < 6; ++k) a[i][j] += tool->inverse_mass[6 * i + k] * stiff[k][j];
    }
  }
  // Gauss elimination with row pivots.
  for (int c = 0; c < 6; ++c) {
    int p = c;
    for (int r = c + 1; r < 6; ++r)
      if (fabs(a[r][c]) > fabs(a[p][c])) p = r;
    for (int k = 0; k < 7; ++k) {
      const float swap = a[c][k];
      a[c][k] = a[p][k];
      a[p][k] = swap;
    }
    for (int r = 0; r < 6; ++r) {
      const float share = r == c ? 0.0f : a[r][c] / a[c][c];
      for (int k = c; k < 7; ++k) a[r][k] -= share * a[c][k];
    }
  }
  for (int i = 0; i < 6; ++i) tool->twist[i] -= a[i][6] / a[i][i];
}

// Result of contact and resting ground for one near node, from apply_contact. Arrays have one entry
// per velocity field: [0] front, [1] back.
typedef struct NodeResult {
  // Velocity that particles receive [m/s], and mass divided by the node's free fraction [kg].
  float4 seen[2];
  // Velocities before and after contact, for the host.
  ContactRecord records[2];
  // 1 if contact changed a field of the node, else 0.
  int changed;
} NodeResult;

// Applies the final contact impulses to both fields of a node, and then the hold of the resting
// ground. near, n, key: as in add_sums; ground: heights of resting ground in the node's block. The
// records contain the velocities before and after contact, but before the hold of the ground, so
// that the host can sum the impulses on tools.
static inline NodeResult apply_contact(int near, int n, int3 key, global const BlockFloor* ground,
                                       NODE_ARGS) {
  const int i = near_node(near, n);
  const float z = (float)(n >> 4);
  const bool held = z <= ground->held[n & 15];
  const float4 below = z - vload4(n & 15, ground->around[0]);
  NodeResult out;
  out.changed = 0;
  for (int s = 0; s < 2; ++s) {
    const float4 v = s == 0 ? before0[i] : before1[i];
    // Velocity and normal impulse.
    // Without contact, before and after are equal bits: the host skips such records.
    float4 after = (float4)(v.xyz, 0.0f);
    ContactNode node;
    if (LOAD_NODE(&node)) {
      global const Tool* tool = tools + node_tool[i];
      ContactBranch branch;
      const float3 j = contact_impulse(&node, vload3(0, tool->twist), vload3(1, tool->twist),
                                       reach.opening, &branch);
      if (branch.acts) {
        after = (float4)(v.xyz + j / node.m, dot(j, node.n));
        out.changed = 1;
      }
    }
    const ContactRecord record = {{v.x, v.y, v.z}, v.w, {after.x, after.y, after.z}, after.w};
    out.records[s] = record;
    // Mass per free volume beside ground and plate.
    const float beside =
        (s == 0 ? 1.0f : -1.0f) * shell[i].distance - tools[max(node_tool[i], 0)].half_thickness;
    const float free_fraction = v.w == 0.0f     ? 1.0f
                                : split[i] == 0 ? free_fraction_above(below)
                                                : free_fraction_between(below, beside);
    out.seen[s] = (float4)(held ? (float3)(0.0f) : after.xyz, v.w / free_fraction);
  }
  return out;
}

#endif  // NAVVY_KERNELS_SOIL_CONTACT_NODE_H
