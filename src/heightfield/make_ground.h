// SPDX-License-Identifier: Apache-2.0
// Builds the ground from the description of a scene.
#pragma once

#include <string>

#include "heightfield/layered_ground.h"
#include "scene/scene.h"

namespace navvy::heightfield {

/// Builds the site of `world`, procedural or from a file, in columns of world.solver.cell.
///
/// The size asked for is rounded up to blocks of 4 x 4 columns; without an origin the middle of the
/// site is W (0, 0). Bedrock (the datum) lies `depth` below the lowest point of the surface.
/// Heights of a site from a file are W z = file z - Setup::height_offset. With
/// SteepGround::kSettle, slopes above the friction angle of the surface soil slide once, which
/// needs the whole surface in memory (at most kMostSettledColumns). `report`, when given, receives
/// the findings in a terrain file as text for people.
/// @throws InputError with every fault found: bad numbers, unknown soils, a file that is missing,
/// off the map or not readable by this build.
Ground make_ground(const scene::Scene& world, std::string* report = nullptr);

/// Returns the height of the rock in W [m]: the plane that the scene gives, or `depth` below the
/// `lowest` point of the surface.
/// @throws InputError when that plane has less than a centimetre of soil above it somewhere.
double bedrock(const scene::Scene& world, double lowest);

/// Largest number of columns that can be settled.
inline constexpr int kMostSettledColumns = 4000000;

/// Returns the number of columns along a side of `length` [m], rounded up to a multiple of 4 (soil
/// blocks).
int site_columns(double length, double cell);

}  // namespace navvy::heightfield
