// SPDX-License-Identifier: Apache-2.0
// Maps for whoever cannot wait for the loop: numbered updates that are whole or not there.
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

/// What changed between two maps of one site, and the later of them. Immutable.
struct MapUpdate {
  /// Number of the map that it counts from; 0: from nothing. All is new then, and `time` may be
  /// before that of a map seen earlier.
  std::uint64_t since = 0;
  std::uint64_t sequence = 0;  ///< of `map`, from 1 on, by one each
  double time = 0;             ///< simulated, of `map` [s]
  /// At most 64, hold every column with a changed value; may overlap.
  std::vector<heightfield::CellRect> rects;
  /// Columns with a changed value. Of several updates united nobody counts them: then the area of
  /// `rects`, at most the site's, which is as many or more.
  std::int64_t changed = 0;
  /// Whether `rects` hold many columns that did not change: more than twice `changed`, or several
  /// updates united.
  bool merged = false;
  TerrainMap map;
};

/// Columns of which any layer differs. Costs a look at every tile, and at the columns of tiles that
/// differ.
std::int64_t count_changed(const TerrainMap& before, const TerrainMap& after);

/// The updates of one site: a writer publishes, any number of readers poll, wait or are called.
///
/// A reader gets an update whole, as a map that nobody writes to any more. One that missed some
/// gets one update from the map it has seen to the newest, with the rectangles of all between
/// united; they come from the last kKept updates, for an older reader the whole site is told.
/// Thread-safe.
class UpdateFeed {
 public:
  static constexpr std::size_t kKept = 1024;
  using Update = std::shared_ptr<const MapUpdate>;

  explicit UpdateFeed(MapOptions options);

  /// Makes the map of `view`, numbers it and calls those that subscribed, on this thread. Nothing
  /// is published where no column changed; the answer is then the newest update. A view of an
  /// earlier time begins anew, as `restart` does. One thread at a time. @throws InputError as
  /// MapMaker::update.
  Update publish(const heightfield::TerrainView& view);
  /// For a world that was put into another state: what is published next counts from nothing for
  /// every reader, whether anything changed or not, and of what was before it nothing is known
  /// (`disturbed_at`). Numbers go on. Of the thread that publishes.
  void restart();
  /// The newest one; null before the first.
  Update latest() const;
  /// From map number `seen` to the newest; null when that is the newest, or there is none. A number
  /// that was never given out counts as 0, and so does one from before a `restart`.
  Update since(std::uint64_t seen) const;
  /// Waits for what `since` would tell. Null after `seconds`, and after `close`.
  Update wait(std::uint64_t seen, double seconds) const;
  /// Called with every update from now on, until `close`. It must not publish.
  void subscribe(std::function<void(const Update&)> reader);
  /// Wakes everybody who waits; nothing is published after it.
  void close();
  bool closed() const;

 private:
  struct PastUpdate {
    std::uint64_t sequence;
    std::vector<heightfield::CellRect> rects;
  };
  Update since_locked(std::uint64_t seen) const;

  mutable std::mutex mutex_;
  mutable std::condition_variable news_;
  MapMaker maker_;        // of the publishing thread alone
  bool restart_ = false;  // likewise
  Update latest_;
  std::deque<PastUpdate> steps_;  // since the last map that counts from nothing
  std::vector<std::function<void(const Update&)>> readers_;
  bool closed_ = false;
};

}  // namespace navvy::map
