// SPDX-License-Identifier: Apache-2.0
// Functions of the two levers of an excavator's operator: joint, direction and valve opening.
#pragma once

#include <array>

#include "scene/machine.h"

namespace navvy::vehicle {

/// Joint of a lever's axis, as index in scene::Machine; -1 if the arm has no joint of this role.
/// `sign` converts the lever's direction into the joint's.
struct LeverFunction {
  int joint = -1;
  double sign = 1;
};

/// Functions by axis: left lever sideways and fore-and-aft, then the right lever. A lever is
/// positive to the right and away from the operator.
///
/// In both patterns the left lever swings sideways, and the right lever moves the bucket sideways
/// (to the left curls it in). Fore and aft, ISO moves the stick with the left lever and the boom
/// with the right one, SAE vice versa: away lowers the boom and pushes the stick out.
using LeverFunctions = std::array<LeverFunction, 4>;
inline constexpr std::array<const char*, 4> kLeverNames = {"left_x", "left_y", "right_x",
                                                           "right_y"};
/// Returns the functions of a machine's levers for its pattern (scene::Machine::levers).
LeverFunctions lever_functions(const scene::Machine& machine);

/// Returns the opening of the valve, -1 to 1, for a lever at `deflection`, clamped to -1 to 1:
/// closed within the dead band, proportional from its edge on, fully open at the end.
double lever_opening(double deflection, double dead_band);

}  // namespace navvy::vehicle
