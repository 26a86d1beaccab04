// SPDX-License-Identifier: Apache-2.0
// Soils that rigs start from when the user names none.
#pragma once

#include "scene/soil.h"

namespace navvy::lab {

/// Dry sand without cohesion and without swell: 1600 kg/m3, E 1 MPa, tool friction 20 degrees. phi
/// in degrees.
scene::Soil clean_sand(double phi_degrees);
/// The same with cohesion that does not fall with remoulding [Pa].
scene::Soil cohesive(double phi_degrees, double cohesion);
/// The same soil against smooth walls: no friction and no adhesion on tools, for the side plates of
/// plane-strain rigs.
scene::Soil without_tool_friction(scene::Soil soil);
/// Plane-strain friction angle of a soil of which only the angle of repose is known, both [rad]:
/// flowing soil mobilises tau / sigma_n = sin phi, so sin phi = tan repose. @throws InputError
/// above 45 degrees.
double friction_from_repose(double repose);

/// Whether remoulding takes cohesion away. No formula for a constant cohesion speaks of such a
/// soil.
bool softens(const scene::Soil& soil);

}  // namespace navvy::lab
