// SPDX-License-Identifier: Apache-2.0
// Arithmetic of one node: the free fraction, i.e. the fraction of the node's kernel that soil can
// fill, and the inverse of the node's mass. One source for both schedules, the native loop and the
// double-precision twin.
//
// Resting ground and plates occupy a part of a node's kernel. Node masses divided by the free
// fraction show how densely soil is packed right up to walls; plain sums would show half of that
// [docs/soil.md, free volume]. `columns` holds one number for each of the four columns around a
// node (a float4). On the host, where the ground is level around a node, it is a single number.
#ifndef NAVVY_KERNELS_SOIL_NODE_H
#define NAVVY_KERNELS_SOIL_NODE_H

#include "soil/layout.h"

// Defines a function `name` on values of type `type` that returns the fraction of a node's kernel,
// a quadratic B-spline, that is on the node's side of a plane. t: distance of the node in front of
// the plane [cells]; negative if the node is behind it.
#define KERNEL_SHARE(name, type)                                                      \
  INLINED type name(type t) {                                                         \
    const type a = clamp(t, -0.5f, 0.5f);                                             \
    const type low = clamp(1.5f + t, 0.0f, 1.0f), high = clamp(1.5f - t, 0.0f, 1.0f); \
    return 0.5f + a * (0.75f - a * a * (scalar)(1.0 / 3.0)) +                         \
           (low * low * low - high * high * high) * (scalar)(1.0 / 6.0);              \
  }
KERNEL_SHARE(kernel_share, columns)

// Returns the free fraction of a node above ground and beside a plate, at least
// SCHEME(min_free_fraction). below: height of the node above each of the four columns around it
// [cells]; negative inside a column. beside: distance of the node from the plate [cells].
INLINED scalar free_fraction_between(columns below, scalar beside) {
  return fmax(mean_of(kernel_share(below)) * mean_of(kernel_share((columns)(beside))),
              SCHEME(min_free_fraction));
}

// Returns the free fraction of a node without a plate; `below` as in free_fraction_between.
INLINED scalar free_fraction_above(columns below) {
  return all(below >= 1.5f) ? 1.0f : free_fraction_between(below, 1.5f);
}

// Returns the share of its velocity downwards that the topmost held node of resting ground keeps: 0
// where soil rests on the ground, 1 where it still falls [docs/soil.md, resting ground]. mass,
// mass_above: of the node and of the node above it [kg]; below: as in free_fraction_between.
//
// A node that is held stops soil that is up to one and a half cells above the ground. Such soil is
// packed less densely at this node than at the node above it.
INLINED scalar falling_share(scalar mass, scalar mass_above, columns below) {
  const scalar here = mass * mean_of(kernel_share(below + 1.0f));
  const scalar above = mass_above * mean_of(kernel_share(below));
  const scalar lacks = SCHEME(gap_closed) * above - here;
  const scalar most = (SCHEME(gap_closed) - SCHEME(gap_open)) * above;
  const scalar share = lacks > 0.0f ? clamp(lacks / most, 0.0f, 1.0f) : 0.0f;
  return share * share;
}

// Returns 1 / m [1/kg] for the mass of a node or of several nodes at once; 0 for a node lighter
// than a mass quantum, which counts as empty. With momentum p, the velocity after gravity is p
// INVERSE_MASS(m) + g dt where m > MASS_QUANTUM.
#define INVERSE_MASS(m) ((m) > MASS_QUANTUM ? 1.0f / (m) : 0.0f)

#endif  // NAVVY_KERNELS_SOIL_NODE_H
