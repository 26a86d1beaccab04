// SPDX-License-Identifier: Apache-2.0
// Contact of one side of a plate with one node: the share of the plate's speed that the node must
// keep up with, the area of plate that it represents, the largest shear impulse, and the impulse.
//
// One source for the kernels and the double-precision twin, in the dialect of kernels/README.md.
// Lengths are in cells unless another unit is given. The following parameters occur in most
// functions:
//
// clearance: distance from the face of the plate to the node [cells]
//
// inset: distance of the node from the nearest free edge, along the plate [cells]
//
// fill: mass of the node / mass of a full node, see contact_touch
#ifndef NAVVY_KERNELS_SOIL_CONTACT_LAW_H
#define NAVVY_KERNELS_SOIL_CONTACT_LAW_H

#include "soil/edge_law.h"
#include "soil/scheme_constants.h"
#include "soil/tool.h"

#define REACH_SCALAR(name) scalar name;
// Parameters of the contact; REACH_FIELDS in tool.h explains each of them.
typedef struct Reach {
  REACH_FIELDS(REACH_SCALAR)
} Reach;
#undef REACH_SCALAR

// Returns x limited to 0 .. 1.
INLINED scalar contact_unit(scalar x) { return fmin(fmax(x, 0.0f), 1.0f); }

// Returns the weight of a node by its distance from the free edge, along the plate: 0 at the edge,
// 1 well inside.
INLINED scalar contact_along(scalar inset, const Reach* r) {
  return contact_unit((inset - r->edge + 0.5f * r->edge_ramp) / r->edge_ramp);
}

// Returns the weight of a node by its distance from the plate: 1 at the plate, 0 beyond the reach
// of the contact.
INLINED scalar contact_near(scalar clearance, const Reach* r) {
  return contact_unit((r->h + 0.5f * r->ramp - clearance) / r->ramp);
}

// Returns the share of the plate's speed that a node must keep up with, 0 .. 1
// [docs/tools.md, contact shares]. The weight along the plate is squared. With its first power,
// half of the share would act at the edge and push a wedge of soil that is only half there.
INLINED scalar contact_share(scalar clearance, scalar inset, const Reach* r) {
  const scalar along = contact_along(inset, r);
  return contact_near(clearance, r) * along * along;
}

// Returns the speed at which a node settles towards a plate that does not advance [m/s].
//
// down: component along gravity of the plate's normal towards the node; 1 for a node directly below
// the plate.
//
// A full node does not settle: there is no gap between soil and plate, and settling would remove
// the pressure of the soil on the plate. A node above the soil's surface contains only the last of
// the soil's mass. It must not carry a plate that rests on the soil, or light plates would stand
// off from it [docs/tools.md, stand-off]. Soil beside or above a plate is held whatever the node's
// fill, because nodes at the soil's own surface are half empty as well. The square lets a plate
// fall through nodes that carry almost no load, and settle onto those that carry almost all of it.
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

// Returns the length of plate that a node represents, measured perpendicular to the free edge
// [cells]. Nodes just inside the edge also represent the length that the ramp at the edge cuts off.
INLINED scalar contact_inner(scalar inset, const Reach* r) {
  const scalar inside = (inset - r->edge) / r->edge_ramp - 0.5f;
  const scalar hat = fmax(0.0f, 1.0f - fabs(inside));
  return contact_along(inset, r) + hat * (r->edge / r->edge_ramp);
}

// Returns the area of plate that a node represents [cell faces].
//
// As a function of the clearance it is a hat function. Its sum over a row of nodes is 1 wherever
// the plate is between them. Its maximum is half a cell closer to the plate than the reach of the
// contact, where soil in contact always has mass. The sum over a plate equals its area except at
// corners; the host corrects each tool for those (Tool.adhesion).
INLINED scalar contact_area(scalar clearance, scalar inset, const Reach* r) {
  const scalar off = clearance - (r->h - 0.5f);
  return fmax(0.0f, 1.0f - fabs(off)) * contact_inner(inset, r);
}

// Returns the share of a node's area that soil wets, 0 .. 1. fill: mass of the node / mass of soil
// in bank state that fills the node's free volume. Soil at its loose density wets the whole area.
INLINED scalar contact_touch(scalar fill) { return contact_unit(fill * SCHEME(contact_touch)); }

// Returns the amount that adhesion adds to the largest shear impulse of a node [N s], beyond
// friction x normal impulse. adhesion: adhesion stress [Pa]; area: from contact_area [cell faces].
// Adhesion acts in shear only and ends with the contact: soil on tools carries no tension
// [docs/tools.md, adhesion].
INLINED scalar contact_stick(scalar adhesion, scalar area, const Reach* r) {
  return adhesion * area * r->patch;
}

// Contact data of one velocity field of one node.
typedef struct ContactNode {
  // v: velocity [m/s]; r: lever arm from the tool's origin [m]; n: unit normal from the plate
  // towards the node.
  scalar3 v, r, n;
  // m: mass [kg]; share: from contact_share; settling: from contact_settling [m/s].
  scalar m, share, settling;
  // mu: friction coefficient; stick: largest shear impulse without any normal impulse [N s].
  scalar mu, stick;
  // edge: largest impulse of the plate's edge on a node ahead of it [N s]; 0 for a node beside a
  // face. slow: speed below which the plate counts as standing still [m/s], for edges only.
  scalar edge, slow;
} ContactNode;

// State of one contact, as contact_impulse found it.
typedef struct ContactBranch {
  // acts: there is an impulse; pushing: the impulse has a normal component; sticking: the impulse
  // stops all slip.
  bool acts, pushing, sticking;
  // Part of a small increase of the plate's normal speed by which the normal speed of the node
  // increases; valid if `pushing` is true.
  scalar held;
} ContactBranch;

// Returns the impulse of the edge of a plate on a node ahead of it [N s] [docs/tools.md, edges]:
// what stops the node's approach along the plate's outward direction, up to the bearing resistance.
// A plate that stops is therefore still supported. plate: velocity of the plate at the node [m/s];
// branch: output, as in contact_impulse.
INLINED scalar3 edge_impulse(const ContactNode* node, scalar3 plate, ContactBranch* branch) {
  const scalar approach = dot(plate - node->v, node->n);
  branch->acts = branch->pushing = approach > 0.0f;
  branch->sticking = false;
  const scalar needed = node->m * fmax(approach, 0.0f);
  const scalar most =
      node->edge * edge_share(dot(plate, node->n), sqrt(dot(plate, plate)), node->slow);
  // At the limit the impulse does not depend on the plate's speed.
  branch->held = needed < most ? 1.0f : 0.0f;
  return fmin(needed, most) * node->n;
}

// Returns the impulse of a tool on a node [N s] [docs/tools.md, impulse]; zero without contact.
// spin: angular velocity of the tool [rad/s]; speed: velocity of the tool's origin [m/s]; opening:
// separation speed above which adhesion has ended [m/s]; branch: output, the state of the contact.
//
// The impulse is unilateral, with Coulomb friction and adhesion, and acts on the whole mass of the
// node. Speeds are relative to the resting ground. A partly covered node lags behind a plate that
// advances, by the share that the plate does not cover. It settles slowly towards a plate that
// stands still or recedes, and still carries the whole load of that plate.
INLINED scalar3 contact_impulse(const ContactNode* node, scalar3 spin, scalar3 speed,
                                scalar opening, ContactBranch* branch) {
  const scalar3 plate = speed + cross(spin, node->r);
  if (node->edge > 0.0f) return edge_impulse(node, plate, branch);
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
