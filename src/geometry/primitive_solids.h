// SPDX-License-Identifier: Apache-2.0
// Volume and inertia of primitive bodies in closed form; geometry/solid_properties.h computes those
// of meshes.
#pragma once

#include "geometry/solid_properties.h"

namespace navvy::geometry {

/// Properties of homogeneous bodies of 1 kg/m3, lengths [m] above zero. Each body is centred at its
/// own origin with its axis along z. A cone's base is at -length / 2, so its centre of mass is a
/// quarter of the length above the base.
SolidProperties solid_box(const Vec3& edges);
SolidProperties solid_sphere(double radius);
SolidProperties solid_cylinder(double radius, double length);
SolidProperties solid_cone(double radius, double length);
/// Returns the properties of a cylinder of `length` with a hemisphere at either end.
SolidProperties solid_capsule(double radius, double length);

/// Returns the properties in frame A of a body whose frame B has the pose X_AB.
SolidProperties placed(const SolidProperties& body, const Pose& X_AB);

/// Returns the properties of both bodies as one, about their common centre of mass. Both have been
/// multiplied by their densities, so `volume` is a mass. Space that they share counts twice.
SolidProperties joined(const SolidProperties& a, const SolidProperties& b);

/// Returns the body with volume and inertia multiplied by `density` [kg/m3].
SolidProperties weighed(SolidProperties body, double density);

}  // namespace navvy::geometry
