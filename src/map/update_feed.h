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

/// A map, and the columns in which it differs from an earlier map of the same site. Immutable.
struct MapUpdate {
  /// Sequence number of the earlier map. 0 means that there is none: all columns count as changed,
  /// and `time` may be before the time of a map published earlier.
  std::uint64_t since = 0;
  /// Sequence number of `map`. The first update has number 1, and each further one the next number.
  std::uint64_t sequence = 0;
  /// Simulated time of `map` [s].
  double time = 0;
  /// Rectangles, at most 64, that cover all columns with a changed value. They may overlap.
  std::vector<heightfield::CellRect> rects;
  /// Number of columns with a changed value. If several updates were combined, this is an upper
  /// bound: the total area of `rects`, at most that of the site.
  std::int64_t changed = 0;
  /// True if `rects` may contain many unchanged columns: their area is more than twice `changed`,
  /// or several updates were combined.
  bool merged = false;
  /// The map after the update.
  TerrainMap map;
};

/// Returns the number of columns in which any layer differs between two maps of a site. Takes one
/// comparison per tile, and a pass over the columns of tiles that differ.
std::int64_t count_changed(const TerrainMap& before, const TerrainMap& after);

/// Distributes the map updates of one site. One thread publishes; any number of readers poll for
/// updates, wait for them, or are called with them.
///
/// The map in an update never changes. A reader that missed updates gets a single one, from the map
/// it has seen to the latest map, which combines the rectangles of all updates in between. These
/// are stored for the last kKept updates; a reader that is further behind gets the whole site.
/// Thread-safe.
class UpdateFeed {
 public:
  /// Number of past updates whose rectangles are stored.
  static constexpr std::size_t kKept = 1024;
  /// Pointer to an update, which readers share; null where there is no update.
  using Update = std::shared_ptr<const MapUpdate>;

  /// Makes a feed whose maps have the given options. No map exists until the first call of
  /// `publish`.
  explicit UpdateFeed(MapOptions options);

  /// Makes the map of `view`, gives it the next sequence number, calls the subscribers on this
  /// thread, and returns the update. If no column changed, publishes nothing and returns the latest
  /// update. A view with an earlier time than the latest map has the effect of `restart` first.
  /// Only one thread may publish at a time.
  /// @throws InputError as MapMaker::update.
  Update publish(const heightfield::TerrainView& view);
  /// Announces that the simulation was put into another state. For every reader, the next update
  /// then counts as a new map (MapUpdate::since is 0), whether or not anything changed, and without
  /// earlier history (layer `disturbed_at`). Sequence numbers continue. Must be called by the
  /// publishing thread.
  void restart();
  /// Returns the latest update; null before the first one.
  Update latest() const;
  /// Returns the update from the map with sequence number `seen` to the latest map. Null if `seen`
  /// is the latest map, or if there is no map. A number that was never used, or that is from before
  /// a `restart`, has the effect of 0: the update covers the whole site.
  Update since(std::uint64_t seen) const;
  /// Waits for up to `seconds` until `since(seen)` has a result, and returns the result. Returns
  /// null after that time, or when the feed is closed without one.
  Update wait(std::uint64_t seen, double seconds) const;
  /// Registers `reader`, which is called with every further update until `close`, on the publishing
  /// thread. It must not publish.
  void subscribe(std::function<void(const Update&)> reader);
  /// Ends the feed: waiting readers return, subscribers are dropped, and nothing is published any
  /// more.
  void close();
  /// Returns true if `close` was called.
  bool closed() const;

 private:
  /// Rectangles of a past update.
  struct PastUpdate {
    /// Sequence number of the past update.
    std::uint64_t sequence;
    /// Columns that the update changed.
    std::vector<heightfield::CellRect> rects;
  };
  /// Returns the same as `since(seen)`, for callers that already hold the mutex.
  Update since_locked(std::uint64_t seen) const;

  /// Protects `latest_`, `steps_`, `readers_` and `closed_`.
  mutable std::mutex mutex_;
  /// Notified when an update is published and when the feed is closed.
  mutable std::condition_variable news_;
  /// Makes the maps. Only the publishing thread uses it.
  MapMaker maker_;
  /// True if the next update counts as a new map. Only the publishing thread uses it.
  bool restart_ = false;
  /// Latest published update; null before the first one.
  Update latest_;
  /// Updates published after the last one with MapUpdate::since = 0, oldest first, at most kKept.
  std::deque<PastUpdate> steps_;
  /// Functions that are called with every update, in the order of their registration.
  std::vector<std::function<void(const Update&)>> readers_;
  /// True after `close` was called.
  bool closed_ = false;
};

}  // namespace navvy::map
