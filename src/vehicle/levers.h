// SPDX-License-Identifier: Apache-2.0
// Control levers of an excavator's operator: which joint each lever axis moves, in which direction,
// and how far it opens the valve.
#pragma once

#include <array>

#include "scene/machine.h"

namespace navvy::vehicle {

/// Joint that one axis of a control lever moves.
struct LeverFunction {
  /// Index of the joint in scene::Machine; -1 if the machine has no joint for this function.
  int joint = -1;
  /// Factor 1 or -1 that converts a lever's positive direction to the joint's positive direction.
  double sign = 1;
};

/// Functions of the four lever axes: left lever sideways, left lever fore-and-aft, right lever
/// sideways, right lever fore-and-aft. A lever is positive to the right and away from the operator.
///
/// In both control patterns (ISO and SAE), moving the left lever sideways swings the machine, and
/// moving the right lever sideways moves the bucket (to the left curls it in). In the ISO pattern,
/// fore-and-aft movement of the left lever moves the stick and that of the right lever the boom; in
/// the SAE pattern it is the other way round. Pushing a lever away lowers the boom or extends the
/// stick.
using LeverFunctions = std::array<LeverFunction, 4>;
/// Names of the four lever axes in the order of LeverFunctions.
inline constexpr std::array<const char*, 4> kLeverNames = {"left_x", "left_y", "right_x",
                                                           "right_y"};
/// Returns the functions of the machine's lever axes for its control pattern,
/// scene::Machine::levers.
LeverFunctions lever_functions(const scene::Machine& machine);

/// Returns the valve opening, -1 to 1, for a lever at `deflection`, which is clamped to -1 to 1.
///
/// The valve is closed while the magnitude of the deflection is below `dead_band` (0 to 1). Beyond
/// it, the opening grows linearly up to 1 at full deflection.
double lever_opening(double deflection, double dead_band);

}  // namespace navvy::vehicle
