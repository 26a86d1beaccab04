// SPDX-License-Identifier: Apache-2.0
// Contacts of near nodes with tools, and the small linear system for the twist of a tool that
// yields to the soil. One source for both schedules (lanes and groups).
//
// A contact is one velocity field of one node that a tool may act on. The kernel contact_nodes
// lists the contacts of each near block, BLOCK_CONTACTS at most; sums and impulses then run over
// the lists only.
//
// The including file chooses the dialect: soil/lanes/lanes.h or soil/scalar.h.
#ifndef NAVVY_KERNELS_SOIL_CONTACT_NODE_H
#define NAVVY_KERNELS_SOIL_CONTACT_NODE_H

#include "soil/contact_law.h"
#include "soil/node.h"

// Returns the index of node n (0 .. 63) of near block `near` in the arrays of near nodes.
static inline int near_node(int near, int n) { return near * BLOCK_NODES + n; }
// Returns the offset of node n (0 .. 63) from the lower corner of its block [cells].
static inline int3 in_block(int n) { return (int3)(n & 3, (n >> 2) & 3, n >> 4); }

// Loads what stays the same during a transfer of the contact of field s (0 front, 1 back) of one
// near node into `node`: share, normal, friction, adhesion and settling; zeros for a node ahead of
// an edge. Returns false, with `node` incomplete, if the node has no contact.
//
// i: index of the node in the near arrays. dx: edge of a cell [m]. field: velocities [m/s] and
// masses [kg] of field s. edge: from the kernel edge_nodes. The other pointers are the near arrays
// of NearNodes and ShellQuery.
static inline bool load_node(ContactNode* node, int s, int i, float dx, Reach reach,
                             global const float4* field, global const int* split,
                             global const int* node_tool, global const NodeShell* shell,
                             global const ContactSoil* surface, global const float4* edge,
                             global const Tool* tools) {
  // Nodes with one field are ahead of an edge, or have no contact.
  if (split[i] == 0 && (s != 0 || all(edge[i].xyz == 0.0f))) return false;
  const float4 v = field[i];
  if (!(v.w > MASS_QUANTUM)) return false;
  global const Tool* tool = tools + node_tool[i];
  if (tool->active == 0) return false;
  node->share = node->settling = node->mu = node->stick = 0.0f;
  node->n = (float3)(0.0f);
  if (split[i] == 0) return true;
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
#define NODE_ARGS                                                                               \
  global const float4 *restrict before0, global const float4 *restrict before1,                 \
      global const int *restrict split, global const int *restrict node_tool,                   \
      global const NodeShell *restrict shell, global const ContactSoil *restrict surface,       \
      global const float4 *restrict edge, global const Tool *restrict tools, const Reach reach, \
      const float dx
// The arguments of NODE_ARGS, to pass them on.
#define NODE_SAME before0, before1, split, node_tool, shell, surface, edge, tools, reach, dx

// Writes what stays the same during a transfer of the contact of field s of node n in near block
// `near` to `out`. Returns false if there is no contact.
static inline bool find_contact(NodeContact* out, int s, int near, int n, NODE_ARGS) {
  const int i = near_node(near, n);
  ContactNode node;
  if (!load_node(&node, s, i, dx, reach, s == 0 ? before0 : before1, split, node_tool, shell,
                 surface, edge, tools))
    return false;
  vstore3(node.n, 0, out->n);
  out->share = node.share;
  out->settling = node.settling;
  out->mu = node.mu;
  out->stick = node.stick;
  out->edge = 0.0f;
  out->place = CONTACT_PLACE(s, n, split[i] == 0 ? 1 : 0, node_tool[i]);
  return true;
}

// Writes what changes in every step to a contact of near block `near` (with block coordinates
// `key`): velocity, mass and lever arm, and the largest impulse of an edge. before0, before1, edge,
// tools, reach, dx: as in load_node.
static inline void update_contact(global NodeContact* contact, int near, int3 key,
                                  global const float4* before0, global const float4* before1,
                                  global const float4* edge, global const Tool* tools, Reach reach,
                                  float dx) {
  const int n = CONTACT_NODE(contact->place), i = near_node(near, n);
  const float4 v = CONTACT_FIELD(contact->place) == 0 ? before0[i] : before1[i];
  vstore3(v.xyz, 0, contact->v);
  contact->m = v.w;
  // Lever arm from the tool's origin [m]. Both points are relative to the window corner, so that no
  // digits are lost far from the site's origin.
  global const Tool* tool = tools + CONTACT_TOOL(contact->place);
  const int3 place = 4 * key + in_block(n);
  vstore3(dx * (convert_float3(place - 4 * vload3(0, tool->window)) - vload3(0, tool->origin)), 0,
          contact->r);
  if (!CONTACT_EDGE(contact->place)) return;
  vstore3(edge[i].xyz, 0, contact->n);
  contact->edge = edge[i].w * reach.patch;
}

// Returns the impulse of the tool on a contact [N s], and its state in `branch`. node: output, the
// contact as the law reads it.
static inline float3 impulse_on(global const NodeContact* contact, global const Tool* tools,
                                Reach reach, ContactNode* node, ContactBranch* branch) {
  node->v = vload3(0, contact->v);
  node->r = vload3(0, contact->r);
  node->n = vload3(0, contact->n);
  node->m = contact->m;
  node->share = contact->share;
  node->settling = contact->settling;
  node->mu = contact->mu;
  node->stick = contact->stick;
  node->edge = contact->edge;
  node->slow = reach.slow;
  // Soil above the edge may have no weight left.
  branch->acts = false;
  if (CONTACT_EDGE(contact->place) && !(contact->edge > 0.0f)) return (float3)(0.0f);
  global const Tool* tool = tools + CONTACT_TOOL(contact->place);
  return contact_impulse(node, vload3(0, tool->twist), vload3(1, tool->twist), reach.opening,
                         branch);
}

// Initial value of a ContactSums.
#define NO_SUMS \
  { {0.0f}, {0.0f}, 0.0f }

// Sums over contacts, and what adds to them; a schedule may have its own, with the same functions.
#ifndef SUMS
#define SUMS ContactSums

// Adds a moment and a force to the sums.
static inline void add_wrench(SUMS* sums, float3 moment, float3 force) {
  const float w[6] = {moment.x, moment.y, moment.z, force.x, force.y, force.z};
  for (int i = 0; i < 6; ++i) sums->wrench[i] += w[i];
}

// Adds held g g^T with g = (moment, d) to the upper triangle of the symmetric 6 x 6 stiffness, row
// by row.
static inline void add_outer(SUMS* sums, float held, float3 moment, float3 d) {
  const float g[6] = {moment.x, moment.y, moment.z, d.x, d.y, d.z};
  int k = 0;
  for (int row = 0; row < 6; ++row)
    for (int col = row; col < 6; ++col) sums->stiffness[k++] += held * g[row] * g[col];
}

// Adds m g g^T for each axis of W in turn, with g = (r x axis, axis).
static inline void add_axes(SUMS* sums, float m, float3 r) {
  for (int a = 0; a < 3; ++a) {
    const float3 axis = (float3)(a == 0, a == 1, a == 2);
    add_outer(sums, m, cross(r, axis), axis);
  }
}
#endif

// Adds a contact to the sums for its tool: the wrench of the impulse J (moment about the tool's
// origin, force), and the stiffness matrix G^T m P G. m is the node's mass, G maps the tool's twist
// to the plate's velocity at the node, and P is the part of that velocity which the contact
// transfers to the node: its share along the normal, and all of the slip if the contact sticks
// [docs/tools.md, two-way solve].
static inline void add_sums(SUMS* sums, global const NodeContact* contact, global const Tool* tools,
                            Reach reach) {
  ContactNode node;
  ContactBranch branch;
  const float3 j = impulse_on(contact, tools, reach, &node, &branch);
  if (!branch.acts) return;
  // The sums are of impulses on soil; the tool gets the opposite ones.
  const float3 l = cross(node.r, j);
  add_wrench(sums, l, j);
  // Three axes when the contact sticks, which also cover the normal, and a correction along the
  // normal. Each adds m p g g^T with g = (r x d, d) and the part p that is passed on.
  if (branch.sticking) add_axes(sums, node.m, node.r);
  const float along_normal =
      (branch.pushing ? branch.held : 0.0f) - (branch.sticking ? 1.0f : 0.0f);
  if (along_normal == 0.0f) return;
  add_outer(sums, node.m * along_normal, cross(node.r, node.n), node.n);
}

// Newton iterations of the two-way solve. Contact is piecewise linear, so few are enough.
#define CONTACT_SWEEPS 3

// Returns true if a tool yields to the soil: a scripted one has no mobility, and nothing is to be
// solved for.
static inline bool yields(global const Tool* tool) {
  if (tool->active == 0) return false;
  float most = 0.0f;
  for (int i = 0; i < 36; ++i) most = fmax(most, fabs(tool->inverse_mass[i]));
  return most > 0.0f;
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

// Applies the impulse of the final twist to a contact. Returns its record for the host, with the
// velocities before and after contact, but before the hold of the resting ground, so that the host
// can sum the impulses on tools. Writes the velocity that particles receive to `seen`: that of the
// contact's field and node in the arrays of the near block `near`, which is active block `block`.
static inline ContactRecord apply_contact(global const NodeContact* contact, int near, int block,
                                          global const BlockFloor* ground, global const Tool* tools,
                                          Reach reach, global float4* velocity0,
                                          global float4* velocity1) {
  ContactNode node;
  ContactBranch branch;
  const float3 j = impulse_on(contact, tools, reach, &node, &branch);
  // Without an impulse, before and after are equal bits: the host skips such records.
  const float3 after = branch.acts ? node.v + j / node.m : node.v;
  const ContactRecord record = {{node.v.x, node.v.y, node.v.z},
                                node.m,
                                {after.x, after.y, after.z},
                                branch.acts ? dot(j, node.n) : 0.0f,
                                contact->place};
  const int n = CONTACT_NODE(contact->place);
  const bool held = (float)(n >> 4) <= ground->held[n & 15];
  global float4* seen = CONTACT_FIELD(contact->place) == 0
                            ? velocity0 + (size_t)block * BLOCK_NODES + n
                            : velocity1 + near_node(near, n);
  if (branch.acts && !held) vstore3(after, 0, (global float*)seen);
  return record;
}

#endif  // NAVVY_KERNELS_SOIL_CONTACT_NODE_H
