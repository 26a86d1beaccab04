// SPDX-License-Identifier: Apache-2.0
// Finds the machines, soils and scenes that Navvy ships.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "scene/soil.h"

namespace navvy::scene_io {

/// Returns the paths of the shipped machines, keyed by the NAME that scenes use in model://NAME.
/// All data directories are searched; if several contain a name, the first one in search order is
/// used.
std::map<std::string, std::string> shipped_machines();

/// Returns the paths of the shipped scenes, keyed by name, e.g. "trench" or "paper/ackermann".
std::map<std::string, std::string> shipped_scenes();

/// Returns the path of the scene file that a user means by `name`: a path, or the name of a shipped
/// scene with or without ".sdf". An existing file takes precedence over a shipped scene. An unknown
/// name that contains a '/' is returned unchanged, as the loader then reports the missing file.
/// @throws InputError that suggests the most similar shipped scene, for any other unknown name
std::string find_scene(const std::string& name);

/// Returns the path of the machine file that a user means by `name`: a path, or the name of a
/// shipped machine. An existing file takes precedence over a shipped machine. `where` states in
/// messages where the name was given. @throws InputError that suggests the most similar shipped
/// machine, for an unknown name
std::string find_machine(const std::string& name, const std::string& where);

/// Returns the shipped soils, in the order of their file names. @throws InputError if the directory
/// with soils is not found
std::vector<scene::Soil> shipped_soils();

/// Returns the shipped soil with this name. `where` states in messages where the name was given,
/// e.g. "--soil". @throws InputError that suggests the most similar soil, if there is none.
scene::Soil shipped_soil(const std::string& name, const std::string& where);

/// Returns the description of a file as one line: the first XML comment that is not a licence line.
/// Returns an empty text if there is none in the first 4 KiB.
std::string description_of(const std::string& file);

}  // namespace navvy::scene_io
