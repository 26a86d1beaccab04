// SPDX-License-Identifier: Apache-2.0
// From a scene's description of its ground to the ground itself.
#pragma once

#include <string>

#include "heightfield/layered_ground.h"
#include "scene/scene.h"

namespace navvy::heightfield {

/// Builds the site of `world`: procedural or from a file, in columns of world.solver.cell.
///
/// The site is as large as asked, rounded up to blocks of 4 x 4 columns; without an origin its
/// middle is W (0, 0). Bedrock (the datum) lies `depth` below the lowest point of the surface.
/// Heights of a file site are W z = file z - Setup::height_offset. With SteepGround::kSettle slopes
/// above the surface soil's friction angle slide once, which needs the whole surface in memory (at
/// most kMostSettledColumns). When `report` is given it receives what was found in a terrain file,
/// for people.
/// @throws InputError with every fault found: bad numbers, unknown soils, a file that is missing,
/// off the map or not readable by this build.
Ground make_ground(const scene::Scene& world, std::string* report = nullptr);

/// Height of the rock in W [m]: the plane that the scene gives, else `depth` below the `lowest` of
/// the surface.
/// @throws InputError when that plane has less than a centimetre of soil above it somewhere.
double bedrock(const scene::Scene& world, double lowest);

inline constexpr int kMostSettledColumns = 4000000;

/// Columns along a side of `length` [m]: rounded up to a multiple of 4 (soil blocks).
int site_columns(double length, double cell);

}  // namespace navvy::heightfield
