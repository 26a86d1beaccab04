// SPDX-License-Identifier: Apache-2.0
// The present state of a session as frames of a replay.
#pragma once

#include <cstddef>
#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <vector>

#include "record/replay_heights.h"
#include "session/session.h"
#include "sim/visible_soil.h"

namespace navvy::record {

/// Makes the header and the frames of a replay (docs/reference/results.md, "Replay") of a session,
/// for a file or for subscribers of a live view. Reads the session and changes nothing in it.
///
/// A frame costs a pass over the particles.
class ReplayFrames {
 public:
  /// Prepares for `session`, which must outlive this object. A frame has at most about
  /// `most_particles` particles: of more that are in the air, in buckets and in beds, every n-th.
  ReplayFrames(const session::Session& session, std::size_t most_particles);

  /// Returns the header, whose `rate_hz` is `rate`. Must be called before the first frame, as
  /// `start` holds the heights before it.
  nlohmann::json header(double rate) const;
  /// Returns the present state without the members `key` and `tiles`.
  nlohmann::json frame();
  /// Returns the tiles of the ground at the last call of `frame`, as ReplayHeights::take does.
  std::vector<std::int16_t> tiles(bool all);

 private:
  /// Returns the places of loose soil apart from the ground: x, y, z from the corner and base of
  /// the heights, in the unit that the header names.
  std::vector<std::int16_t> particles() const;

  const session::Session& session_;
  std::size_t most_particles_;
  sim::VisibleSoil soil_;
  ReplayHeights heights_;
};

}  // namespace navvy::record
