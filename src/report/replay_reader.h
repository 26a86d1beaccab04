// SPDX-License-Identifier: Apache-2.0
// Reads replay.jsonl of a run's folder, thinned evenly.
#pragma once

#include <cstddef>
#include <nlohmann/json_fwd.hpp>
#include <string>

namespace navvy::report {

/// Numbers of what a file holds.
struct ReplayCounts {
  std::size_t frames = 0;  ///< frames
  std::size_t unread = 0;  ///< rows that could not be read
};

/// Returns the number of frames in the file; 0 if there is no such file.
std::size_t count_frames(const std::string& file);

/// Sets the members `grid`, `start`, `design`, `soils`, `links`, `cylinders` and `forces` of a
/// page's run from the first row of a replay. @throws InputError if the row is not such a header.
void read_header(const std::string& row, nlohmann::json& run);

/// Sets the members `grid`, `start`, `design`, `soils`, `links`, `cylinders`, `forces` and `frames`
/// of a page's run. Of the frames it takes every one whose number is a multiple of `every`, and the
/// last one. A frame holds all tiles of the ground that changed since the one taken before it.
/// @throws FileError if the file cannot be read; InputError if its header is not that of a replay.
ReplayCounts read_replay(const std::string& file, std::size_t every, nlohmann::json& run);

}  // namespace navvy::report
