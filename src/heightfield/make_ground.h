// SPDX-License-Identifier: Apache-2.0
// Builds the ground that a scene describes.
#pragma once

#include <string>

#include "heightfield/layered_ground.h"
#include "scene/scene.h"

namespace navvy::heightfield {

/// Builds the ground of `world` from shapes or from a terrain file, with columns of edge
/// world.solver.cell.
///
/// The requested size is rounded up to multiples of 4 columns. If the scene gives no origin, the
/// centre of the site is at world (0, 0). Bedrock (the datum) lies at the plane that the scene
/// gives, or `depth` below the lowest point of the surface. For a terrain file, world z = file
/// height - Setup::height_offset.
///
/// With SteepGround::kSettle, slopes steeper than the friction angle of the surface soil slide once
/// before the run. This needs the whole surface in memory, so the site may have at most
/// kMostSettledColumns columns. If `report` is not null, it receives a description of the terrain
/// file for the user; it is cleared if there is no file.
/// @throws InputError for invalid numbers, unknown soils, or a terrain file that is missing, does
/// not cover the site, or cannot be read by this build.
Ground make_ground(const scene::Scene& world, std::string* report = nullptr);

/// Returns the world z of bedrock [m]: the plane that the scene gives, or else the scene's `depth`
/// below `lowest`, the lowest point of the surface [m].
/// @throws InputError if the given plane is less than 1 cm below `lowest`.
double bedrock(const scene::Scene& world, double lowest);

/// Maximum number of columns of a site that can be settled (SteepGround::kSettle).
inline constexpr int kMostSettledColumns = 4000000;

/// Returns the number of columns of edge `cell` [m] along a site of `length` [m], rounded up to a
/// multiple of 4, the width of a soil block.
int site_columns(double length, double cell);

}  // namespace navvy::heightfield
