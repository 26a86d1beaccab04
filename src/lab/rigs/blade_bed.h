// SPDX-License-Identifier: Apache-2.0
// Common parts of the rigs `blade` and `wall`: the soil bed ahead of an upright face, and the
// theoretical force on that face.
#pragma once

#include <functional>
#include <string>

#include "lab/theory/formulas.h"
#include "lab/tool_driver.h"

namespace navvy::lab {

/// Returns the input of the blade formulas for the soil of `setup`: `rake` [rad], `depth` and
/// `width` [m] of the blade, or of a wall, whose height is the depth. The cohesion is the residual
/// one, because the formulas assume a constant cohesion. The surcharge is 0.
BladeCase blade_case(const Setup& setup, double rake, double depth, double width);

/// Theoretical force on a flat upright tool in plane strain.
struct Reference {
  /// Expected force along the ground, for the width of the blade case [N].
  double expected = 0;
  /// Lower and upper bound of the force along the ground that the theory gives, before any
  /// tolerance is added [N].
  double low = 0, high = 0;
  /// Expected vertical force on the tool, positive downwards [N].
  double vertical = 0;
  /// Name of the theory and its reference in docs/bibliography.md.
  std::string source;
  /// True if the tool has friction or adhesion, so that slip lines and a log spiral give the force;
  /// false for a smooth tool, for which Rankine's formula does.
  bool rough = false;
};
/// Returns the theoretical force on an upright blade. A smooth blade gets Rankine's passive force.
/// A blade with tool friction or adhesion gets the two bounds of rough_passive; the expected force
/// is the lower bound.
Reference upright_reference(const BladeCase& blade);

/// Returns true if the point `p` [m] is below the blade's cutting edge or ahead of its face, and
/// false in the trench behind the face. The cutting edge is at x = 0 and z = -`depth` [m]; `rake`
/// is the face's angle [rad]. Points closer to the face than a tenth of `cell` [m] count as behind
/// it.
bool ahead_of_blade(const Vec3& p, double depth, double rake, double cell);
/// Returns a function of (x, y) for Site::rest that gives the surface height [m]: 0 ahead of x = 0,
/// and -`depth` behind it, where the blade has dug a trench.
std::function<double(double, double)> trench(double depth);
/// Returns `report` with the final entries of a blade experiment: the number of particles that
/// crossed the blade, the momentum error, the trace of `driver`, and the general properties of the
/// run (Site::finish).
Report finish_blade(Site& site, const ToolDriver& driver, Report report);

}  // namespace navvy::lab
