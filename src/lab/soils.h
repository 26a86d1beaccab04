// SPDX-License-Identifier: Apache-2.0
// Soils that rigs use by default.
#pragma once

#include "scene/soil.h"

namespace navvy::lab {

/// Returns a dry sand with the friction angle `phi_degrees` [deg]: bank density 1600 kg/m3, no
/// cohesion, no swell, and a friction angle of 20 degrees on tools.
scene::Soil clean_sand(double phi_degrees);
/// Returns the soil of clean_sand with a constant `cohesion` [Pa]: remoulding does not reduce it.
scene::Soil cohesive(double phi_degrees, double cohesion);
/// Returns `soil` without friction and adhesion on tools, for the smooth side plates of
/// plane-strain rigs.
scene::Soil without_tool_friction(scene::Soil soil);
/// Returns the friction angle in plane strain [rad] of a soil whose angle of repose is `repose`
/// [rad]. On a flowing slope, shear stress / normal stress is sin phi, so sin phi = tan repose.
/// @throws InputError unless `repose` is between 0 and 45 degrees.
double friction_from_repose(double repose);

/// Returns true if remoulding reduces the soil's cohesion, that is, if the residual cohesion is
/// below the cohesion. Formulas for a constant cohesion do not apply to such a soil.
bool softens(const scene::Soil& soil);

}  // namespace navvy::lab
