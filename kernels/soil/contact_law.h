// SPDX-License-Identifier: Apache-2.0
// Contact of one side of a plate with one node: the share of the contact, the area of plate that
// the node stands for, the largest shear impulse, and the impulse.
//
// One source for the kernels and the double twin, in the dialect of kernels/README.md. Lengths are
// in cells unless a unit is given.
#ifndef NAVVY_KERNELS_SOIL_CONTACT_LAW_H
#define NAVVY_KERNELS_SOIL_CONTACT_LAW_H

#include "soil/scheme_constants.h"
#include "soil/tool.h"

// Parameters of the contact; REACH_FIELDS of tool.h explains them.
#define REACH_SCALAR(name) scalar name;
typedef struct Reach {
  REACH_FIELDS(REACH_SCALAR)
} Reach;
#undef REACH_SCALAR

INLINED scalar contact_unit(scalar x) { return fmin(fmax(x, 0.0f), 1.0f); }

// Returns the weight of a node along the plate by its distance from the free edge: 0 at the edge, 1
// inside.
INLINED scalar contact_along(scalar inset, const Reach* r) {
  return contact_unit((inset - r->edge + 0.5f * r->edge_ramp) / r->edge_ramp);
}

// Returns the weight of a node across the plate: 1 at the plate, 0 beyond its reach.
INLINED scalar contact_near(scalar clearance, const Reach* r) {
  return contact_unit((r->h + 0.5f * r->ramp - clearance) / r->ramp);
}

// Returns the share of the plate's speed that a node must keep up with, 0 .. 1
// [docs/tools.md, contact shares]. The weight along the plate is squared: half a share at the edge
// would push a wedge of soil that is only half there.
INLINED scalar contact_share(scalar clearance, scalar inset, const Reach* r) {
  const scalar along = contact_along(inset, r);
  return contact_near(clearance, r) * along * along;
}

// Returns the speed at which a node settles towards a plate that does not advance [m/s].
//
// down: component along gravity of the plate's normal towards the node. fill: mass of the node /
// mass of a full node, see contact_touch.
//
// A full node does not settle: there is no clearance between soil and plate, and settling would
// take the soil's pressure off the plate. A node above the soil's surface holds only the last of
// the soil's mass. It must not carry a plate that lies on the soil, or light plates stand off
// [docs/tools.md, stand-off]. Soil beside or above a plate is held whatever the node's fill, as
// nodes at the soil's own surface are half empty, too. The square lets a plate fall through nodes
// that carry hardly any load and settle onto those that carry almost all of it.
INLINED scalar contact_settling(scalar clearance, scalar fill, scalar down, const Reach* r) {
  const scalar under = fmax(down, 0.0f), full = contact_unit(SCHEME(contact_full) * fill),
               near = contact_near(clearance, r);
  const scalar no_clearance =
      full * (1.0f - under) +
      contact_unit(SCHEME(contact_bearing_slope) * fill - SCHEME(contact_bearing_offset)) * under;
  const scalar holds = near + (1.0f - near) * no_clearance;
  const scalar gives = 1.0f - holds * (1.0f - under * (1.0f - full));
  return gives * (r->settling + under * gives * r->falling);
}

// Returns the length of plate that a node stands for, measured across its free edge [cells]. Nodes
// just inside the edge take over what the ramp cuts off.
INLINED scalar contact_inner(scalar inset, const Reach* r) {
  const scalar inside = (inset - r->edge) / r->edge_ramp - 0.5f;
  const scalar hat = fmax(0.0f, 1.0f - fabs(inside));
  return contact_along(inset, r) + hat * (r->edge / r->edge_ramp);
}

// Returns the area of plate that a node stands for [cell faces].
//
// Across the plate this is a hat function. Its sum over a row of nodes is 1 wherever the plate lies
// between them. Its centre is half a cell closer than the reach, where soil in contact always has
// mass. The sum over a plate is its area except at corners; the host scales each tool for those
// (Tool.adhesion).
INLINED scalar contact_area(scalar clearance, scalar inset, const Reach* r) {
  const scalar off = clearance - (r->h - 0.5f);
  return fmax(0.0f, 1.0f - fabs(off)) * contact_inner(inset, r);
}

// Returns the wetted share of the area of a node. fill: mass of the node / mass that a full node
// holds in its free volume. Soil at its loose density wets the whole area.
INLINED scalar contact_touch(scalar fill) { return contact_unit(fill * SCHEME(contact_touch)); }

// Returns what adhesion [Pa] on the area of a node adds to the largest shear impulse mu x push
// [N s]. Adhesion acts in shear only and ends with the contact: soil on tools carries no tension
// [docs/tools.md, adhesion].
INLINED scalar contact_stick(scalar adhesion, scalar area, const Reach* r) {
  return adhesion * area * r->patch;
}

// One side of one node.
typedef struct ContactNode {
  // Velocity [m/s], lever arm from the tool's origin [m], normal away from the plate.
  scalar3 v, r, n;
  // Mass [kg], contact_share, contact_settling [m/s].
  scalar m, share, settling;
  // Tangent of the friction angle; largest shear impulse without any push [N s].
  scalar mu, stick;
} ContactNode;

// State of one contact, as contact_impulse found it.
typedef struct ContactBranch {
  // There is an impulse; it acts along the normal; it stops all slip.
  bool acts, pushing, sticking;
  // Normal impulse that a faster plate adds / (mass x its gain of speed).
  scalar held;
} ContactBranch;

// Returns the impulse on a node [N s] from a tool that turns with `spin` [rad/s] and whose origin
// moves with `speed` [m/s] [docs/tools.md, impulse]. It is unilateral, with Coulomb friction and
// adhesion, and acts on the whole mass of the node. Without contact it is 0.
//
// Speeds are relative to the resting ground. A partly covered node falls behind a plate that
// advances, by the share that the plate does not cover. It settles slowly towards a plate that
// stands or recedes, which still carries its whole load.
INLINED scalar3 contact_impulse(const ContactNode* node, scalar3 spin, scalar3 speed,
                                scalar opening, ContactBranch* branch) {
  const scalar3 plate = speed + cross(spin, node->r);
  const scalar3 rel = node->v - plate;
  const scalar leaves = dot(rel, node->n), advance = dot(plate, node->n);
  const scalar behind = (1.0f - node->share) * advance;
  const scalar rn = leaves + fmax(behind, node->settling);
  branch->held = behind > node->settling ? node->share : 1.0f;
  branch->pushing = rn < 0.0f;
  // Soil that settles towards the plate has not separated from it.
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
