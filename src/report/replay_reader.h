// SPDX-License-Identifier: Apache-2.0
// Reads replay.jsonl of a run's folder, thinned evenly.
#pragma once

#include <cstddef>
#include <nlohmann/json.hpp>
#include <string>

namespace navvy::report {

/// The parts of a page that replay.jsonl gives.
struct Replay {
  /// Members `grid`, `start`, `design`, `soils`, `links`, `cylinders`, `forces` and `frames` of the
  /// page's run.
  nlohmann::json members = nlohmann::json::object();
  std::size_t frames = 0;  ///< frames in the file
  std::size_t unread = 0;  ///< rows that could not be read
};

/// Returns the number of frames in the file; 0 if there is no such file.
std::size_t count_frames(const std::string& file);

/// Returns every frame whose number is a multiple of `every`, and the last one. A frame holds all
/// tiles of the ground that changed since the one returned before it.
/// @throws FileError if the file cannot be read; InputError if its header is not that of a replay.
Replay read_replay(const std::string& file, std::size_t every);

}  // namespace navvy::report
