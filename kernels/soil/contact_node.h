// SPDX-License-Identifier: Apache-2.0
// Contact of one node with a tool, and the two-way solve's small system; the same source in both schedules.
#ifndef NAVVY_KERNELS_SOIL_CONTACT_NODE_H
#define NAVVY_KERNELS_SOIL_CONTACT_NODE_H

#include "common/portable.h"
#include "soil/layout.h"
#include "soil/room.h"

#define CONTACT_T float
#define CONTACT_LIT(x) ((float)(x))
#define CONTACT_MIN(a, b) fmin(a, b)
#define CONTACT_MAX(a, b) fmax(a, b)
#define CONTACT_ABS(a) fabs(a)
#define CONTACT_FN static inline
#include "soil/contact_law.h"

typedef struct Node {
  float3 v, r, n;  // velocity, lever arm from the tool's origin [m], normal away from the plate on this field's side
  float m, b, mu, stick;  // mass, weight, tan of the friction angle, most shear without any push [N s]
} Node;

typedef struct Branch {
  bool acts, pushing, sticking;  // at all; in the normal direction; slip is stopped whole
} Branch;

// Impulse on the node [N s] for the tool's twist, and how it came about. Twin: soil/reference/double_contact.h.
static inline float3 impulse(const Node* node, float3 spin, float3 speed, float opening, Branch* branch) {
  const float3 rel = node->v - (speed + cross(spin, node->r));
  const float rn = dot(rel, node->n);
  branch->pushing = rn < 0.0f;
  branch->acts = branch->pushing || (node->stick > 0.0f && rn < opening);
  branch->sticking = false;
  if (!branch->acts) return (float3)(0.0f);
  const float jn = branch->pushing ? -node->m * rn : 0.0f;
  const float3 t = rel - rn * node->n;
  const float speed_t = sqrt(dot(t, t));
  const float most = node->mu * jn + node->stick;
  branch->sticking = node->m * speed_t <= most;
  const float3 jt = branch->sticking ? node->m * t : t * (most / fmax(speed_t, 1e-12f));
  return node->b * (jn * node->n - jt);
}

// Field s (0 front, 1 back) of one near node; false when there is nothing to solve.
static inline bool load_node(Node* node, int s, int slot, int n, int3 key, float dx, Reach reach,
                             global const float4* field, global const int* split, global const int* node_tool,
                             global const float8* shell, global const float4* surface, global const float* tools,
                             int only) {
  const int i = slot * BLOCK_NODES + n;
  if (split[i] == 0) return false;
  const float4 v = field[i];
  if (!(v.w > MASS_QUANTUM)) return false;
  const int tool = node_tool[i];
  global const float* at = tools + TOOL_WORDS * tool;
  if (at[TOOL_ACTIVE] == 0.0f || (only >= 0 && only != tool)) return false;
  const float sign = s == 0 ? 1.0f : -1.0f;
  const float8 q = shell[i];
  const float clearance = sign * q.s3 - at[TOOL_HALF];
  node->b = contact_weight(clearance, q.s4, &reach);
  if (!(node->b > 0.0f)) return false;
  node->v = v.xyz;
  node->m = v.w;
  node->n = sign * q.s012;
  const float4 soil = surface[i];  // tan of the tool friction angle, adhesion [Pa], 1 / bank density
  node->mu = soil.x * at[TOOL_FRICTION];
  node->stick = 0.0f;
  if (soil.y > 0.0f) {
    const float room = fmax(kernel_share((float4)(clearance)).x, LEAST_ROOM);
    const float touch = contact_touch(v.w * soil.z / (dx * dx * dx * room));
    const float adhesion = soil.y * at[TOOL_ADHESION] * touch;
    node->stick = contact_stick(adhesion, contact_area(clearance, q.s4, &reach), node->b, &reach);
  }
  const int3 p = 4 * (key - as_int3(vload3(0, at + TOOL_WINDOW))) + (int3)(n & 3, (n >> 2) & 3, n >> 4);
  node->r = dx * (convert_float3(p) - vload3(0, at + TOOL_ORIGIN));
  return true;
}

#define BLOCK_ARGS global const int* restrict near_list, global const int4* restrict keys
#define NODE_ARGS                                                                                                 \
  global const float4 *restrict before0, global const float4 *restrict before1, global const int *restrict split, \
      global const int *restrict node_tool, global const float8 *restrict shell,                                  \
      global const float4 *restrict surface, global const float4 *restrict frame, const int first_tool,           \
      const int only, const Reach reach, const float dx
#define NODE_SAME before0, before1, split, node_tool, shell, surface, frame, first_tool, only, reach, dx
#define NODE_PASS key, dx, reach, s == 0 ? before0 : before1, split, node_tool, shell, surface, tools, only

// Adds field s of near node n of a block to the sums: the wrench of J (angular about the tool's origin, linear) and
// G^T b m P G, where P is what of the node's velocity the contact holds: the normal, the slip, or both.
static inline void add_sums(float* out, int s, int slot, int n, int3 key, NODE_ARGS) {
  global const float* tools = (global const float*)(frame + first_tool);
  Node node;
  if (!load_node(&node, s, slot, n, NODE_PASS)) return;
  global const float* at = tools + TOOL_WORDS * node_tool[slot * BLOCK_NODES + n];
  Branch branch;
  const float3 j = impulse(&node, vload3(0, at + TOOL_SPIN), vload3(0, at + TOOL_SPEED), reach.opening, &branch);
  if (!branch.acts) return;
  const float3 l = cross(node.r, j);
  out[0] += l.x;
  out[1] += l.y;
  out[2] += l.z;
  out[3] += j.x;
  out[4] += j.y;
  out[5] += j.z;
  // Directions held: three axes when it sticks, the normal when it pushes; what sticks without push leaves the normal
  // out. Each adds b m g g^T with g = (r x d, d).
  for (int a = branch.sticking ? 0 : 3; a < 4; ++a) {
    if (a == 3 && branch.pushing == branch.sticking) continue;
    const float3 d = a == 3 ? node.n : (float3)(a == 0, a == 1, a == 2);
    const float bm = a == 3 && !branch.pushing ? -node.b * node.m : node.b * node.m;
    const float3 moment = cross(node.r, d);
    const float g[6] = {moment.x, moment.y, moment.z, d.x, d.y, d.z};
    int k = 6;
    for (int row = 0; row < 6; ++row)
      for (int col = row; col < 6; ++col) out[k++] += bm * g[row] * g[col];
  }
}

// One sweep of the two-way solve: F(V) = V - V_start + W sum J(V) = 0 with slope 1 + W K, W the inverse mass. at: the
// tool's words; total: CONTACT_SUMS.
static inline void solve_twist(global float* at, const float* total) {
  float a[6][7], stiff[6][6];
  for (int i = 0, k = 6; i < 6; ++i)
    for (int j = i; j < 6; ++j) stiff[i][j] = stiff[j][i] = total[k++];
  for (int i = 0; i < 6; ++i) {
    const float now = i < 3 ? at[TOOL_SPIN + i] : at[TOOL_SPEED + i - 3];
    a[i][6] = now - at[TOOL_START + i];
    for (int j = 0; j < 6; ++j) {
      a[i][j] = i == j ? 1.0f : 0.0f;
      a[i][6] += at[TOOL_YIELD + 6 * i + j] * total[j];
      for (int k = 0; k < 6; ++k) a[i][j] += at[TOOL_YIELD + 6 * i + k] * stiff[k][j];
    }
  }
  // Gauss with row pivots.
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
  for (int i = 0; i < 6; ++i) {
    const float change = a[i][6] / a[i][i];
    if (i < 3)
      at[TOOL_SPIN + i] -= change;
    else
      at[TOOL_SPEED + i - 3] -= change;
  }
}

// What contact, resting ground and room make of near node n: see contact_apply.
typedef struct Result {
  float4 felt[2];  // per field, what particles will feel
  float8 books[2];
  int changed;
} Result;

static inline Result apply_contact(int slot, int n, int3 key, global const float* ground, NODE_ARGS) {
  global const float* tools = (global const float*)(frame + first_tool);
  const int i = slot * BLOCK_NODES + n;
  const float z = (float)(n >> 4);
  const bool held = z <= ground[n & 15];
  const float4 below = z - vload4(n & 15, ground + FLOOR_COLUMNS);
  Result out;
  out.changed = 0;
  for (int s = 0; s < 2; ++s) {
    const float4 v = s == 0 ? before0[i] : before1[i];
    float4 after = (float4)(v.xyz, 0.0f);
    Node node;
    if (load_node(&node, s, slot, n, NODE_PASS)) {
      global const float* at = tools + TOOL_WORDS * node_tool[i];
      Branch branch;
      const float3 j = impulse(&node, vload3(0, at + TOOL_SPIN), vload3(0, at + TOOL_SPEED), reach.opening, &branch);
      if (branch.acts) {
        after = (float4)(v.xyz + j / node.m, dot(j, node.n));
        out.changed = 1;
      }
    }
    out.books[s] = (float8)(v, after);
    // Mass per room, as far as ground and plate leave room on this side.
    const float beside = (s == 0 ? 1.0f : -1.0f) * shell[i].s3 - tools[TOOL_WORDS * max(node_tool[i], 0) + TOOL_HALF];
    const float room = v.w == 0.0f ? 1.0f : split[i] == 0 ? room_above(below) : room_between(below, beside);
    out.felt[s] = (float4)(held ? (float3)(0.0f) : after.xyz, v.w / room);
  }
  return out;
}

#endif  // NAVVY_KERNELS_SOIL_CONTACT_NODE_H
