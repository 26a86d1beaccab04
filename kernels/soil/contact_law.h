// SPDX-License-Identifier: Apache-2.0
// What one side of a plate and one node near it do to each other: the contact's share, the area of
// plate the node stands for, the most it holds in shear, the impulse. One source for the kernels
// and for the double twin, in the dialect of kernels/README.md. Lengths in cells unless said.
#ifndef NAVVY_KERNELS_SOIL_CONTACT_LAW_H
#define NAVVY_KERNELS_SOIL_CONTACT_LAW_H

#include "soil/tool.h"

// See REACH_FIELDS of tool.h.
#define REACH_SCALAR(name) scalar name;
typedef struct Reach {
  REACH_FIELDS(REACH_SCALAR)
} Reach;
#undef REACH_SCALAR

INLINED scalar contact_unit(scalar x) {
  return fmin(fmax(x, 0.0f), 1.0f);
}

// How far a node this far along the plate from its free edge counts: 0 at the edge, 1 inside.
INLINED scalar contact_along(scalar inset, const Reach* r) {
  return contact_unit((inset - r->edge + 0.5f * r->edge_ramp) / r->edge_ramp);
}

// 1 at the plate, 0 from the end of its reach on.
INLINED scalar contact_near(scalar clearance, const Reach* r) {
  return contact_unit((r->h + 0.5f * r->ramp - clearance) / r->ramp);
}

// Share of the plate's speed that a node must keep up with, 0..1 [docs/tools.md, contact shares].
// Squared along the plate: half a share at its edge would push a wedge that is there by half.
INLINED scalar contact_share(scalar clearance, scalar inset, const Reach* r) {
  const scalar along = contact_along(inset, r);
  return contact_near(clearance, r) * along * along;
}

// Speed at which a node settles towards a plate that does not advance [m/s]. `down`: part of the
// plate's normal towards the node along gravity; fill: see contact_touch. Where a node is full
// there is no room between soil and plate to settle into: it would take the soil's pressure off the
// plate. A node over the soil's surface has the last of the soil's mass: it must not carry a plate
// that lies on it, or light ones stand on nothing [docs/tools.md, stand-off]. Soil at the side of a
// plate or above it is held whatever the node has, as nodes at its own surface are half empty, too.
// The square lets a plate fall through what hardly bears and settle onto what almost does. tuned:
// `navvy lab light-tool`; 1.5: soil half as large again as in the bank still fills a node; under a
// plate one that stands off by a quarter of a cell holds 0.8, and 0.9 counts as full.
INLINED scalar contact_settling(scalar clearance, scalar fill, scalar down, const Reach* r) {
  const scalar under = fmax(down, 0.0f), full = contact_unit(1.5f * fill), near = contact_near(clearance, r);
  const scalar no_clearance = full * (1.0f - under) + contact_unit(4.0f * fill - 2.6f) * under;
  const scalar holds = near + (1.0f - near) * no_clearance;
  const scalar gives = 1.0f - holds * (1.0f - under * (1.0f - full));
  return gives * (r->settling + under * gives * r->falling);
}

// Along a plate: how much of its area a node stands for. What is cut off at a free edge is given to
// the nodes just inside.
INLINED scalar contact_inner(scalar inset, const Reach* r) {
  const scalar inside = (inset - r->edge) / r->edge_ramp - 0.5f;
  const scalar hat = fmax(0.0f, 1.0f - fabs(inside));
  return contact_along(inset, r) + hat * (r->edge / r->edge_ramp);
}

// Area of plate a node stands for [cell faces]. A hat across the plate, whose sum over a row of
// nodes is 1 wherever the plate lies between them; its middle half a cell nearer than the reach,
// where soil that touches always has mass. The sum over a plate is its area but for corners, for
// which the host scales the tool (Tool.adhesion).
INLINED scalar contact_area(scalar clearance, scalar inset, const Reach* r) {
  const scalar off = clearance - (r->h - 0.5f);
  return fmax(0.0f, 1.0f - fabs(off)) * contact_inner(inset, r);
}

// Share of the area that soil touches: its mass over what a full node would hold in its room. Soil
// at its loose density touches everywhere.  tuned: none; 0.75 = 1 / 1.33, a large swell.
INLINED scalar contact_touch(scalar fill) { return contact_unit(fill * (scalar)(1.0 / 0.75)); }

// What adhesion [Pa] on the node's area adds to the most tangential impulse mu x push [N s]. It
// holds in shear only and ends with the contact: soil on tools carries no tension, so there is
// nothing to pull at [docs/tools.md, adhesion].
INLINED scalar contact_stick(scalar adhesion, scalar area, const Reach* r) { return adhesion * area * r->patch; }

// One side of one node.
typedef struct ContactNode {
  // Velocity [m/s], lever arm from the tool's origin [m], normal away from the plate
  scalar3 v, r, n;
  scalar m, share, settling;   // mass [kg], contact_share, contact_settling [m/s]
  scalar mu, stick;            // tan of the friction angle, most shear without any push [N s]
} ContactNode;

// How an impulse came about.
typedef struct ContactBranch {
  bool acts, pushing, sticking;  // at all; in the normal direction; slip is stopped whole
  // Normal impulse that a faster plate adds / (mass x its gain of speed)
  scalar held;
} ContactBranch;

// Impulse on the node [N s] of a tool that turns with `spin` [rad/s] and whose origin moves with
// `speed` [m/s]: of its whole mass, unilateral, Coulomb and adhesion [docs/tools.md, impulse].
// Without one that acts it is 0. Speeds are taken against the resting ground: a node that a plate
// covers in part falls behind one that advances, by the share that it does not cover, and settles
// slowly towards one that stands or recedes, with all its load borne.
INLINED scalar3 contact_impulse(const ContactNode* node, scalar3 spin, scalar3 speed, scalar opening,
                                ContactBranch* branch) {
  const scalar3 plate = speed + cross(spin, node->r);
  const scalar3 rel = node->v - plate;
  const scalar leaves = dot(rel, node->n), advance = dot(plate, node->n);
  const scalar behind = (1.0f - node->share) * advance;
  const scalar rn = leaves + fmax(behind, node->settling);
  branch->held = behind > node->settling ? node->share : 1.0f;
  branch->pushing = rn < 0.0f;
  // What may settle towards the plate has not let go.
  branch->acts = branch->pushing || (node->stick > 0.0f && leaves + fmax(behind, 0.0f) < opening);
  branch->sticking = false;
  if (!branch->acts) return (scalar)(0.0) * node->n;
  const scalar jn = branch->pushing ? -node->m * rn : 0.0f;
  const scalar3 slip = rel - leaves * node->n;
  const scalar speed_t = sqrt(dot(slip, slip));
  const scalar most = node->mu * jn + node->stick;
  branch->sticking = node->m * speed_t <= most;
  const scalar stopped = branch->sticking ? node->m : most / fmax(speed_t, (scalar)(1e-12));
  return jn * node->n - slip * stopped;
}

#endif  // NAVVY_KERNELS_SOIL_CONTACT_LAW_H
