// SPDX-License-Identifier: Apache-2.0
// Volume, centre of mass and inertia of bodies that are made of plates.
#pragma once

#include "geometry/solid_properties.h"

namespace navvy::geometry {

/// Computes the properties of a body of plates, of which `mesh` is the middle surface: each
/// triangle is a plate of the given thickness [m], half of it on either side. The sums are exact
/// for these prisms; what two plates share along an edge counts twice. Winding has no influence.
/// The result is empty for a mesh without area.
SolidProperties plate_properties(const TriangleMesh& mesh, double thickness);

}  // namespace navvy::geometry
