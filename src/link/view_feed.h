// SPDX-License-Identifier: Apache-2.0
// The latest frame of a run, for subscribers that each take as many as they can.
#pragma once

#include <array>
#include <condition_variable>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

namespace navvy::link {

/// Hands the frames of a replay from one writer to any number of subscribers. The writer never
/// waits for them: a subscriber that was slow gets the latest frame with every tile of the ground
/// that changed since the one it had, and a new one with every tile that ever changed.
///
/// The memory use follows from the changed part of the ground, not from the length of the run.
/// Thread-safe.
class ViewFeed {
 public:
  /// A frame as a subscriber gets it.
  struct Update {
    std::uint64_t number;  ///< position in the feed, from 1
    std::string text;      ///< JSON in one line: a row of a replay
  };

  /// Adds a frame: a row without `tiles`, which are given as ReplayHeights::take returns them.
  void add(const nlohmann::json& frame, const std::vector<std::int16_t>& tiles);
  /// Waits at most `patience` [s] for a frame after the one with number `seen`, 0 for the first,
  /// and returns the latest one; nothing if there is none yet.
  std::optional<Update> wait(std::uint64_t seen, double patience);
  /// Declares that no frame follows, and why: text for the page.
  void close(const std::string& reason);
  /// Returns the text given to `close`; nothing before.
  std::optional<std::string> end() const;

  /// Waits at most `patience` [s] until there are no subscribers.
  void wait_until_left(double patience);

  /// Counts a subscriber as long as the returned object lives.
  std::shared_ptr<void> subscribe();
  /// Returns the number of present subscribers.
  int subscribers() const;
  /// Returns the number of subscribers so far.
  std::uint64_t subscriptions() const;

 private:
  /// A tile and the number of the frame that changed it last.
  struct Tile {
    std::uint64_t number;
    std::vector<std::int16_t> values;
  };

  mutable std::mutex mutex_;
  std::condition_variable changed_;
  /// The latest frame: its row without the first brace.
  std::shared_ptr<const std::string> frame_;
  /// Number of the latest frame; 0: none.
  std::uint64_t number_ = 0;
  /// Tiles that ever changed, by their place along y and x.
  std::map<std::array<std::int16_t, 2>, Tile> tiles_;
  std::optional<std::string> end_;
  int subscribers_ = 0;
  std::uint64_t subscriptions_ = 0;
};

}  // namespace navvy::link
