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
/// Gives `soil` the friction angle that `test` measures as `angle` [rad]. Its plane-strain angle is
/// up to date after scene::follow_friction_test.
void set_friction(scene::Soil& soil, scene::FrictionTest test, double angle);

/// Returns true if remoulding reduces the soil's cohesion, that is, if the residual cohesion is
/// below the cohesion. Formulas for a constant cohesion do not apply to such a soil.
bool softens(const scene::Soil& soil);

}  // namespace navvy::lab
