// SPDX-License-Identifier: Apache-2.0
// Courant numbers at which the tests of this folder compare results: a result that depends on the
// step is not a result.
#pragma once

#include "scene/scene.h"

namespace navvy::validation {

/// Courant number of scenes that set none [-].
inline constexpr double kUsualCourant = scene::SolverSettings{}.courant;
/// Courant number of half the step [-].
inline constexpr double kHalfCourant = 0.5 * kUsualCourant;

}  // namespace navvy::validation
