// SPDX-License-Identifier: Apache-2.0
// Side files with the masses of a machine's links, for machines whose own file has placeholders.
#pragma once

#include <map>
#include <string>
#include <vector>

namespace navvy::scene_io {

/// Reads masses [kg] by the names of links from a file with one line `link,mass_kg` for each; lines
/// that are empty, begin with # or are that heading are skipped. Each name must be one of `links`.
/// @throws InputError with file, line, value, rule and remedy of the first fault
/// @throws FileError if the file cannot be read
std::map<std::string, double> read_masses(const std::string& file,
                                          const std::vector<std::string>& links);

}  // namespace navvy::scene_io
