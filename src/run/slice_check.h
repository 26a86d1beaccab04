// SPDX-License-Identifier: Apache-2.0
// Warns of cuts that the soil's cells do not resolve.
#pragma once

#include <vector>

#include "core/error.h"
#include "scene/scene.h"

namespace navvy::run {

/// Returns the force on a cutting tool at a depth of `cells` cells of soil, divided by its force in
/// fine cells. Measured for a smooth blade at 0.15 m/s
/// [docs/validation.md, Cells per depth of cut].
double force_share(double cells);

/// Returns a warning for each step whose slices are thinner than four cells of soil, with the force
/// to expect. A step has slices if it has the fields depth_m and pass_depth_m.
std::vector<Fault> check_slices(const scene::Scene& scene);

}  // namespace navvy::run
