// SPDX-License-Identifier: Apache-2.0
// Boxes around collision shapes, for callers that need only a box.
#pragma once

#include <cstddef>
#include <optional>

#include "geometry/oriented_box.h"
#include "scene/machine.h"

namespace navvy::vehicle {

/// Returns the box around a collision shape, in the frame of the link that carries the shape.
/// Returns nothing for a plane, which callers treat as ground, and for a mesh file that cannot be
/// read, which the scene loader has already reported.
std::optional<geometry::OrientedBox> box_of(const scene::Collision& collision);

/// Inertia of a link compared with a solid box around each of its collision shapes.
struct InertiaShare {
  double share = 1;     ///< smallest principal moment / that of the boxes [-]
  double inertia = 0;   ///< that moment of the link [kg m2]
  double expected = 0;  ///< that moment of the boxes, with the mass of the link [kg m2]
};

/// Share of its shapes' inertia below which a link's inertia is implausible [-]: the solver turns
/// such a body by full turns in a step.
inline constexpr double kLeastInertiaShare = 0.01;
/// Ratio of masses that contacts of stacked bodies carry [-]; beyond it they sink into each other.
inline constexpr double kMostMassRatio = 200;

/// Compares the three principal moments of a link, in ascending order, with those of solid boxes
/// around its collision shapes that have its mass together. Returns a share of 1 for a link without
/// collision shapes or without mass.
InertiaShare inertia_share(const scene::Link& link);

/// Box around a wheel, with its twin if it has one.
struct WheelBox {
  std::size_t link = 0;       ///< index of the link that carries the wheel
  geometry::OrientedBox box;  ///< box in the frame of that link; the axle is its y axis
};

/// Returns the box around a wheel of `machine`; nothing if the machine lacks the wheel's joint.
std::optional<WheelBox> box_of(const scene::Machine& machine, const scene::Wheel& wheel);

}  // namespace navvy::vehicle
