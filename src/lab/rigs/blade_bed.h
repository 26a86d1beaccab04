// SPDX-License-Identifier: Apache-2.0
// What the rigs `blade` and `wall` share: the bed ahead of an upright face, and what theory expects
// of it.
#pragma once

#include <functional>
#include <string>

#include "lab/theory/formulas.h"
#include "lab/tool_driver.h"

namespace navvy::lab {

/// What the formulas are asked, of the setup's soil. `depth` and `width` are the caller's: a wall
/// has a height. Cohesion is what is left when the soil is remoulded: the formulas know no
/// softening.
BladeCase blade_case(const Setup& setup, double rake, double depth, double width);

/// What a flat upright tool in plane strain is held against, by its friction with the soil.
struct Reference {
  double expected = 0;       ///< along the ground, for the case's width [N]
  double low = 0, high = 0;  ///< the two ends of what theory allows, without a tolerance [N]
  double vertical = 0;       ///< on the tool, down [N]
  std::string source;        ///< which theory, with its reference
  bool rough = false;        ///< the slip lines' and the log spiral's, not Rankine's
};
/// Smooth: Rankine. With tool friction or adhesion: lower bound and log spiral of
/// theory/earth_pressure.h.
Reference upright_reference(const BladeCase& blade);

/// Inside the ground and not in the trench that stands open behind a blade's face, lip at x = 0.
/// The lattice of particles begins a quarter of a cell ahead of an upright face.
bool ahead_of_blade(const Vec3& p, double depth, double rake, double cell);
/// The surface for the stress at rest: ground ahead of x = 0, `depth` less behind it.
std::function<double(double, double)> trench(double depth);
/// Ends a report: crossings, momentum, the driver's trace, the common lines.
Report finish_blade(Site& site, const ToolDriver& driver, Report report);

}  // namespace navvy::lab
