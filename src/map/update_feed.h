// SPDX-License-Identifier: Apache-2.0
// Numbered map updates for readers that run beside the simulation.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <vector>

#include "map/map_maker.h"

namespace navvy::map {

/// The later of two maps of one site, and what changed in between. Immutable.
struct MapUpdate {
  /// Number of the earlier map. 0 means that the update counts from nothing: everything is new, and
  /// `time` may be before that of a map seen earlier.
  std::uint64_t since = 0;
  /// Number of `map`; updates count from 1 by one.
  std::uint64_t sequence = 0;
  /// Simulated time of `map` [s].
  double time = 0;
  /// Rectangles, 64 at most, that cover every column with a changed value; they may overlap.
  std::vector<heightfield::CellRect> rects;
  /// Number of columns with a changed value. For several united updates it is an upper bound: the
  /// area of `rects`, at most that of the site.
  std::int64_t changed = 0;
  /// True when `rects` cover many columns that did not change: more than twice `changed`, or
  /// several united updates.
  bool merged = false;
  /// The later map.
  TerrainMap map;
};

/// Returns the number of columns in which any layer differs. Costs a comparison per tile, and the
/// columns of the tiles that differ.
std::int64_t count_changed(const TerrainMap& before, const TerrainMap& after);

/// The updates of one site: one writer publishes, any number of readers poll, wait or are called.
///
/// A reader gets whole updates, with a map that no one writes to any more. A reader that missed
/// some gets one update from the map it has seen to the newest, with the rectangles of all updates
/// in between united. They come from the last kKept updates; an older reader gets the whole site.
/// Thread-safe.
class UpdateFeed {
 public:
  /// Number of updates whose rectangles are kept.
  static constexpr std::size_t kKept = 1024;
  /// An update that any number of readers share.
  using Update = std::shared_ptr<const MapUpdate>;

  /// Makes a feed of maps with these options.
  explicit UpdateFeed(MapOptions options);

  /// Makes the map of `view`, numbers it, and calls the subscribers on this thread. Publishes
  /// nothing and returns the newest update where no column changed. A view of an earlier time
  /// starts anew, as `restart` does. Only one thread may publish at a time.
  /// @throws InputError as MapMaker::update.
  Update publish(const heightfield::TerrainView& view);
  /// Announces that the world was put into another state. The next update counts from nothing for
  /// every reader, whether anything changed or not, and the history before it is forgotten
  /// (`disturbed_at`). The numbers go on. Must be called by the publishing thread.
  void restart();
  /// Returns the newest update; null before the first.
  Update latest() const;
  /// Returns the update from map number `seen` to the newest; null when `seen` is the newest or
  /// there is none. A number that was never used, or is from before a `restart`, counts as 0.
  Update since(std::uint64_t seen) const;
  /// Waits until `since` has an answer and returns it. Returns null after `seconds`, and after
  /// `close`.
  Update wait(std::uint64_t seen, double seconds) const;
  /// Registers a function that is called with every further update, until `close`. It must not
  /// publish.
  void subscribe(std::function<void(const Update&)> reader);
  /// Wakes all waiting readers; nothing is published afterwards.
  void close();
  /// Returns true after `close`.
  bool closed() const;

 private:
  // The rectangles of a past update.
  struct PastUpdate {
    std::uint64_t sequence;
    std::vector<heightfield::CellRect> rects;
  };
  /// Answers `since`; the caller holds the mutex.
  Update since_locked(std::uint64_t seen) const;

  mutable std::mutex mutex_;
  mutable std::condition_variable news_;
  // Used by the publishing thread alone, like restart_.
  MapMaker maker_;
  bool restart_ = false;
  Update latest_;
  // Updates since the last map that counts from nothing.
  std::deque<PastUpdate> steps_;
  std::vector<std::function<void(const Update&)>> readers_;
  bool closed_ = false;
};

}  // namespace navvy::map
