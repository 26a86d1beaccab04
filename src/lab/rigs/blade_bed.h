// SPDX-License-Identifier: Apache-2.0
// Common parts of the rigs `blade` and `wall`: the bed ahead of an upright face, and its theory.
#pragma once

#include <functional>
#include <string>

#include "lab/theory/formulas.h"
#include "lab/tool_driver.h"

namespace navvy::lab {

/// Returns the case of the formulas for the setup's soil. `depth` and `width` are the caller's: a
/// wall has a height. The cohesion is the residual one: the formulas know no softening.
BladeCase blade_case(const Setup& setup, double rake, double depth, double width);

/// Theory of a flat upright tool in plane strain, by its friction with the soil.
struct Reference {
  /// Along the ground, for the case's width [N].
  double expected = 0;
  /// Bounds of the theory, without a tolerance [N].
  double low = 0, high = 0;
  /// Force on the tool, down [N].
  double vertical = 0;
  /// Name of the theory, with its reference.
  std::string source;
  /// True for slip lines and log spiral, false for Rankine.
  bool rough = false;
};
/// Returns Rankine for a smooth tool; with tool friction or adhesion the lower bound and the log
/// spiral of theory/earth_pressure.h.
Reference upright_reference(const BladeCase& blade);

/// Returns true inside the ground and outside the trench behind a blade's face, edge at x = 0. The
/// lattice of particles begins a quarter of a cell ahead of an upright face.
bool ahead_of_blade(const Vec3& p, double depth, double rake, double cell);
/// Returns the surface for the stress at rest: ground ahead of x = 0, `depth` lower behind it.
std::function<double(double, double)> trench(double depth);
/// Completes a report: crossings, momentum, the driver's trace, the common lines.
Report finish_blade(Site& site, const ToolDriver& driver, Report report);

}  // namespace navvy::lab
