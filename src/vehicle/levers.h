// SPDX-License-Identifier: Apache-2.0
// What the two levers of an excavator's operator do: which function each axis moves, which way, and
// how far a valve opens.
#pragma once

#include <array>

#include "scene/machine.h"

namespace navvy::vehicle {

/// A joint by its index in scene::Machine, -1: the arm has none of this role; `sign` turns the
/// lever's way into the joint's.
struct LeverFunction {
  int joint = -1;
  double sign = 1;
};

/// By axis: left lever sideways and fore-and-aft, right lever likewise. A lever is positive to the
/// right and away from the operator.
///
/// Both patterns swing with the left lever sideways and turn the bucket with the right one (to the
/// left curls it in). Fore and aft, ISO moves the stick with the left lever and the boom with the
/// right one, SAE the other way round: away lowers the boom and pushes the stick out.
using LeverFunctions = std::array<LeverFunction, 4>;
inline constexpr std::array<const char*, 4> kLeverNames = {"left_x", "left_y", "right_x",
                                                           "right_y"};
LeverFunctions lever_functions(const scene::Machine& machine);

/// Opening of the valve, -1 to 1, of a lever at `way`, cut to -1 .. 1: closed within the dead band,
/// from its edge on in proportion, open at the end.
double lever_opening(double way, double dead_band);

}  // namespace navvy::vehicle
