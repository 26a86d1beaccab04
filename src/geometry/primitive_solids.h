// SPDX-License-Identifier: Apache-2.0
// Volume and inertia of round and square bodies by their formulas, beside those of meshes in
// geometry/solid_properties.h.
#pragma once

#include "geometry/solid_properties.h"

namespace navvy::geometry {

/// Homogeneous bodies of 1 kg/m3, lengths in metres and above zero. Each lies about its own origin
/// with its axis along z; a cone's foot is at -length / 2, so that its centre of mass lies a
/// quarter of the length above the foot.
SolidProperties solid_box(const Vec3& edges);
SolidProperties solid_sphere(double radius);
SolidProperties solid_cylinder(double radius, double length);
SolidProperties solid_cone(double radius, double length);
/// A cylinder of `length` with half a sphere on either end.
SolidProperties solid_capsule(double radius, double length);

/// The body turned and moved: X_AB places its frame in A.
SolidProperties placed(const SolidProperties& body, const Pose& X_AB);

/// Both as one, about their common centre of mass; each has been multiplied by its density before,
/// so `volume` is a mass then. Space that they share counts twice.
SolidProperties joined(const SolidProperties& a, const SolidProperties& b);

/// Volume and inertia times `density`.
SolidProperties weighed(SolidProperties body, double density);

}  // namespace navvy::geometry
