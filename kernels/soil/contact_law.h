// SPDX-License-Identifier: Apache-2.0
// What one side of a plate and one node near it do to each other: the contact's weight, the area of plate the node
// stands for, the most it holds in shear. One source for the kernel (float) and for the host's twin (double).
//
// The includer defines before inclusion: CONTACT_T (scalar), CONTACT_LIT(x), CONTACT_MIN, CONTACT_MAX, CONTACT_ABS and
// CONTACT_FN (function specifiers). Lengths in cells unless said.
#ifndef NAVVY_KERNELS_SOIL_CONTACT_LAW_H
#define NAVVY_KERNELS_SOIL_CONTACT_LAW_H

typedef struct Reach {
  CONTACT_T h, ramp, edge, edge_ramp;  // see ContactSettings
  CONTACT_T rate;                      // dt / reference step
  CONTACT_T patch;                     // face of a cell x dt [m2 s]
  CONTACT_T opening;                   // soil that leaves the plate faster has let go [m/s]
} Reach;

CONTACT_FN CONTACT_T contact_unit(CONTACT_T x) {
  return CONTACT_MIN(CONTACT_MAX(x, CONTACT_LIT(0.0)), CONTACT_LIT(1.0));
}

// How far a node this far along the plate from its free edge counts: 0 at the edge, 1 inside.
CONTACT_FN CONTACT_T contact_along(CONTACT_T inset, const Reach* r) {
  return contact_unit((inset - r->edge + CONTACT_LIT(0.5) * r->edge_ramp) / r->edge_ramp);
}

// Weight of the contact at a node, 0..1, made independent of the step.
// b = 1 - (1 - b)^n is replaced by b n / (1 + (n - 1) b): equal at b = 0 (with slope n), at b = 1 and for n = 1.
CONTACT_FN CONTACT_T contact_weight(CONTACT_T clearance, CONTACT_T inset, const Reach* r) {
  const CONTACT_T near = contact_unit((r->h + CONTACT_LIT(0.5) * r->ramp - clearance) / r->ramp);
  const CONTACT_T b = near * contact_along(inset, r);
  return b * r->rate / (CONTACT_LIT(1.0) + (r->rate - CONTACT_LIT(1.0)) * b);
}

// Along a plate: how much of its area a node stands for. What is cut off at a free edge is given to the nodes just
// inside.
CONTACT_FN CONTACT_T contact_inner(CONTACT_T inset, const Reach* r) {
  const CONTACT_T inside = (inset - r->edge) / r->edge_ramp - CONTACT_LIT(0.5);
  const CONTACT_T hat = CONTACT_MAX(CONTACT_LIT(0.0), CONTACT_LIT(1.0) - CONTACT_ABS(inside));
  return contact_along(inset, r) + hat * (r->edge / r->edge_ramp);
}

// Area of plate a node stands for [cell faces]. A hat across the plate, whose sum over a row of nodes is 1 wherever the
// plate lies between them; its middle half a cell nearer than the reach, where soil that touches always has mass. The
// sum over a plate is its area but for corners, for which the host scales the tool (TOOL_ADHESION).
CONTACT_FN CONTACT_T contact_area(CONTACT_T clearance, CONTACT_T inset, const Reach* r) {
  const CONTACT_T off = clearance - (r->h - CONTACT_LIT(0.5));
  return CONTACT_MAX(CONTACT_LIT(0.0), CONTACT_LIT(1.0) - CONTACT_ABS(off)) * contact_inner(inset, r);
}

// Share of the area that soil touches: its mass over what a full node would hold in its room. Soil at its loose density
// touches everywhere.  tuned: none; 0.75 = 1 / 1.33, a large swell.
CONTACT_FN CONTACT_T contact_touch(CONTACT_T fill) { return contact_unit(fill * CONTACT_LIT(1.0 / 0.75)); }

// What adhesion [Pa] on the node's area adds to the most tangential impulse mu x push, before the weight b [N s]. It
// holds in shear only and ends with the contact: soil carries no tension, so there is nothing to pull at.
CONTACT_FN CONTACT_T contact_stick(CONTACT_T adhesion, CONTACT_T area, CONTACT_T b, const Reach* r) {
  return adhesion * area * r->patch / b;
}

#endif  // NAVVY_KERNELS_SOIL_CONTACT_LAW_H
