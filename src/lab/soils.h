// SPDX-License-Identifier: Apache-2.0
// Default soils of rigs.
#pragma once

#include "scene/soil.h"

namespace navvy::lab {

/// Returns dry sand without cohesion and swell: 1600 kg/m3, E 1 MPa, tool friction 20 degrees. phi
/// in degrees.
scene::Soil clean_sand(double phi_degrees);
/// Returns the same soil with a cohesion [Pa] that remoulding does not reduce.
scene::Soil cohesive(double phi_degrees, double cohesion);
/// Returns the soil against smooth walls, without friction and adhesion on tools, for the side
/// plates of plane-strain rigs.
scene::Soil without_tool_friction(scene::Soil soil);
/// Returns the plane-strain friction angle of a soil of which only the angle of repose is known,
/// both [rad]. Flowing soil mobilises tau / sigma_n = sin phi, so sin phi = tan repose.
/// @throws InputError above 45 degrees.
double friction_from_repose(double repose);

/// Returns true if remoulding reduces the cohesion. Formulas for a constant cohesion do not apply
/// to such a soil.
bool softens(const scene::Soil& soil);

}  // namespace navvy::lab
