// SPDX-License-Identifier: Apache-2.0
// Areas that the bodies of a scene or of a running world occupy, for maps.
#pragma once

#include <vector>

#include "core/math.h"
#include "heightfield/layered_ground.h"
#include "heightfield/occupied_area.h"
#include "scene/scene.h"
#include "sim/world.h"

namespace navvy::sim {

/// Returns true for a machine; false for a body that only stands, moves as one piece, or falls.
bool is_machine(const scene::MachineInWorld& placed);

/// Returns the areas of the bodies of `scene`, whose base links stand at the poses `X_WB` in W, one
/// per machine of the scene, with the joints as in their files. Each collision shape, wheel and
/// shell has an area of its own; planes have none.
/// @param included nonzero for each machine of the scene whose areas are wanted
std::vector<heightfield::OccupiedArea> occupied_areas(const scene::Scene& scene,
                                                      const std::vector<Pose>& X_WB,
                                                      const std::vector<char>& included);
/// Returns the areas of the bodies of a running world at the present time.
std::vector<heightfield::OccupiedArea> occupied_areas(const World& world,
                                                      const std::vector<char>& included);

/// Returns the areas of bodies of a scene that is not running, at their starting poses on `site`,
/// the untouched ground of the scene.
/// @param included nonzero for each machine of the scene whose areas are wanted
heightfield::OccupiedAreas starting_areas(const scene::Scene& scene,
                                          const heightfield::Ground& site,
                                          const std::vector<char>& included);

/// Returns a list that includes all machines of `scene`.
std::vector<char> all_bodies(const scene::Scene& scene);
/// Returns a list that includes the bodies of `scene` that no program, joint or input moves: those
/// whose base is fixed to the world and that have no joints.
std::vector<char> fixed_bodies(const scene::Scene& scene);
/// Returns a list that includes all machines of a world but one and those that are coupled to it by
/// closed hitches. `machine` is the index of the machine in the scene.
std::vector<char> bodies_around(const World& world, int machine);

}  // namespace navvy::sim
