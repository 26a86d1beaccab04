// SPDX-License-Identifier: Apache-2.0
// Volume and inertia of simple bodies from formulas; geometry/solid_properties.h computes those of
// meshes.
#pragma once

#include "geometry/solid_properties.h"

namespace navvy::geometry {

/// Returns the properties of a box with these edge lengths [m] and a density of 1 kg/m3, centred at
/// the origin.
SolidProperties solid_box(const Vec3& edges);
/// Returns the properties of a sphere [m] with a density of 1 kg/m3, centred at the origin.
SolidProperties solid_sphere(double radius);
/// Returns the properties of a cylinder [m] along z with a density of 1 kg/m3, centred at the
/// origin.
SolidProperties solid_cylinder(double radius, double length);
/// Returns the properties of a cone [m] along z with a density of 1 kg/m3. The base is at z =
/// -length / 2 and the tip at z = length / 2, so the centre of mass is at z = -length / 4.
SolidProperties solid_cone(double radius, double length);
/// Returns the properties of a cylinder [m] along z with a hemisphere at each end and a density of
/// 1 kg/m3, centred at the origin. `length` does not include the hemispheres.
SolidProperties solid_capsule(double radius, double length);

/// Returns the properties of a body expressed in a frame A. X_AB is the pose in A of the body's own
/// frame B.
SolidProperties placed(const SolidProperties& body, const Pose& X_AB);

/// Returns the properties of two bodies together, with the inertia about their common centre of
/// mass. Both must have been multiplied by their densities, so that `volume` is a mass. Where the
/// bodies overlap, the mass of both counts.
SolidProperties joined(const SolidProperties& a, const SolidProperties& b);

/// Returns the body with volume and inertia multiplied by `density` [kg/m3], so that they are mass
/// and inertia.
SolidProperties weighed(SolidProperties body, double density);

}  // namespace navvy::geometry
