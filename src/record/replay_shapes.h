// SPDX-License-Identifier: Apache-2.0
// What a replay shows of machines: shapes of their links, cylinders, and tools with forces.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "scene/scene.h"
#include "sim/world.h"

namespace navvy::record {

/// Returns a list with an entry for each link of each machine: `machine`, `link` and its `visuals`.
/// Each visual has a `pose` in the link's frame (x, y, z [m], quaternion w, x, y, z), a `color` and
/// one shape: `box` (edges), `cylinder` (radius, length; axis z), `sphere` (radius) or `mesh`
/// (`points` and `triangles`, base64 of float32 and uint32). Meshes are simplified to a few
/// thousand triangles; a file that cannot be read is left out, as in pictures.
nlohmann::json replay_links(const scene::Scene& scene);

/// Returns a list with `machine`, `radius_m` and `barrel_length_m` of each hydraulic cylinder, in
/// the order of sim::add_cylinder_shapes for one machine after the other.
nlohmann::json replay_cylinders(const sim::World& world);

/// Returns a list with the `name` ("machine/shell") of each tool whose force is recorded, in the
/// order of machines and shells.
nlohmann::json replay_forces(const scene::Scene& scene);

}  // namespace navvy::record
