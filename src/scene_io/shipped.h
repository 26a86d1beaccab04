// SPDX-License-Identifier: Apache-2.0
// The machines, soils and scenes that Navvy ships.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "scene/soil.h"

namespace navvy::scene_io {

/// Returns the files of the shipped machines by name, which scenes use as model://NAME. Searches
/// all data directories; the first one that has a name wins.
std::map<std::string, std::string> shipped_machines();

/// Returns the files of the shipped scenes by name, e.g. "trench" or "paper/ackermann".
std::map<std::string, std::string> shipped_scenes();

/// Returns the scene file that a user means by `name`: a path, or the name of a shipped scene with
/// or without ".sdf". A file of the user's comes first. Returns an unknown path unchanged, as the
/// loader's message is the better one. @throws InputError that names the nearest shipped scene.
std::string find_scene(const std::string& name);

/// Returns the shipped soils, sorted by name. @throws InputError when none are found.
std::vector<scene::Soil> shipped_soils();

/// Returns the shipped soil of this name. `where` names the source of the request in messages, e.g.
/// "--soil". @throws InputError that names the nearest soil.
scene::Soil shipped_soil(const std::string& name, const std::string& where);

/// Returns the description in a file: its first comment that is no licence line, on one line. Empty
/// when there is none in the first 4 KiB.
std::string description_of(const std::string& file);

}  // namespace navvy::scene_io
