// SPDX-License-Identifier: Apache-2.0
// Positions of joints that are not free to choose: those of joints that follow others by a fixed
// ratio, and those of joints in closed loops.
#pragma once

#include <vector>

#include "scene/machine.h"

namespace navvy::scene {

/// Returns how far a closing joint is open: the distance [m] that its halves must move and the
/// angle [rad] that they must turn to meet, in the axes of its parent half. Directions in which the
/// joint moves freely count as zero. `X_BP` and `X_BC` are the poses of parent and child link in
/// one frame.
Vec6 loop_gap(const LoopJoint& loop, const Pose& X_BP, const Pose& X_BC);

/// Sets the followers of all gears in `q` by their leaders' positions, along chains of gears.
void follow_gears(const Machine& machine, std::vector<double>& q);

/// Moves those positions in `q` for which `held` is false until all loops are closed, starting from
/// their values in `q`; followers of gears follow. The search is Gauss-Newton, damped where the
/// loops are near a dead centre, and ends after at most `most` iterations.
/// @return largest gap that remains [m], an angle counting with a lever arm of 1 m; 0 without loops
double close_loops(const Machine& machine, const std::vector<char>& held, std::vector<double>& q,
                   int most = 100);

}  // namespace navvy::scene
