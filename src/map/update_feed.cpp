// SPDX-License-Identifier: Apache-2.0
// Maps share their tiles, so an update is a few pointers: publishing copies nothing, and readers
// hold the lock only briefly.
#include "map/update_feed.h"

#include <algorithm>
#include <array>
#include <bit>
#include <chrono>
#include <tuple>
#include <utility>

namespace navvy::map {
namespace {

using heightfield::CellRect;

/// Counts the columns of one tile in which any layer differs.
class TileComparison {
 public:
  TileComparison(const TerrainMap& a, const TerrainMap& b) : a_(a), b_(b) {
    // Layers that only the earlier map has are not compared: a reader of `b` cannot see them.
    for (const LayerInfo& each : layers())
      if (b.has(each.layer)) layers_.push_back(each.layer);
  }
  std::int64_t changed(int tx, int ty) {
    constexpr int kSide = LayerTiles::kSide;
    const CellRect tile =
        CellRect{tx * kSide, ty * kSide, (tx + 1) * kSide, (ty + 1) * kSide}.cut(b_.rect());
    bool any = false;
    for (const MapLayer layer : layers_) {
      const bool had = a_.has(layer);
      const LayerTiles& now = b_.tiles(layer);
      // One tile for both: nothing of it was written to.
      if (had && a_.tiles(layer).shares(now, tx, ty)) continue;
      // `passing` stores nothing, so that a comparison does not fill the memory with tiles.
      const float* p = had ? a_.tiles(layer).passing(tx, ty, old_) : nullptr;
      const float* q = now.passing(tx, ty, new_);
      if (p == q) continue;
      if (!any) differs_.fill(false);
      any = true;
      for (int iy = 0; iy < tile.y1 - tile.y0; ++iy)
        for (int ix = 0; ix < tile.x1 - tile.x0; ++ix) {
          const auto i = static_cast<std::size_t>(iy * kSide + ix);
          const float u = p != nullptr ? p[i] : kUnknown, v = q != nullptr ? q[i] : kUnknown;
          // Bits are compared, as NaN differs from itself. Unknown values are one NaN (kUnknown).
          if (std::bit_cast<std::uint32_t>(u) != std::bit_cast<std::uint32_t>(v))
            differs_[i] = true;
        }
    }
    return any ? std::count(differs_.begin(), differs_.end(), true) : 0;
  }

 private:
  const TerrainMap &a_, &b_;
  std::vector<MapLayer> layers_;
  LayerTiles::Values old_, new_;
  std::array<bool, std::tuple_size_v<LayerTiles::Values>> differs_{};
};

// Overlaps count twice; the result is an upper bound.
std::int64_t area_of(const std::vector<CellRect>& rects) {
  std::int64_t area = 0;
  for (const CellRect& rect : rects) area += rect.area();
  return area;
}

}  // namespace

std::int64_t count_changed(const TerrainMap& before, const TerrainMap& after) {
  std::int64_t count = 0;
  constexpr int kSide = LayerTiles::kSide;
  // On the heap: the comparison holds two tiles of values (32 KiB) and a flag per column.
  const auto comparison = std::make_unique<TileComparison>(before, after);
  for (int ty = 0; ty * kSide < after.ny(); ++ty)
    for (int tx = 0; tx * kSide < after.nx(); ++tx) count += comparison->changed(tx, ty);
  return count;
}

UpdateFeed::UpdateFeed(MapOptions options) : maker_(std::move(options)) {}

// The map is made before the lock is taken: readers wait for a few pointers only.
UpdateFeed::Update UpdateFeed::publish(const heightfield::TerrainView& view) {
  const Update before = latest();
  const std::uint64_t number = before ? before->sequence + 1 : 1;
  if (before && view.time() < before->time) restart();
  if (restart_) maker_.forget();
  const std::vector<CellRect>& rects = maker_.update(view);
  MapUpdate update{0, number, view.time(), rects, 0, false, maker_.map().numbered(number)};
  const bool same_site = before && !restart_ && before->map.nx() == update.map.nx() &&
                         before->map.ny() == update.map.ny();
  update.since = same_site ? before->sequence : 0;
  update.changed = same_site ? count_changed(before->map, update.map) : update.map.rect().area();
  // The number of a map that equals the one before is used by the next map.
  if (same_site && update.changed == 0) return before;
  update.merged = area_of(update.rects) > 2 * update.changed;
  auto now = std::make_shared<const MapUpdate>(std::move(update));
  std::vector<std::function<void(const Update&)>> readers;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (closed_) return before;
    // From the map before it no way leads to one that counts from nothing.
    if (same_site)
      steps_.push_back({now->sequence, now->rects});
    else
      steps_.clear();
    if (steps_.size() > kKept) steps_.pop_front();
    latest_ = now;
    readers = readers_;
  }
  restart_ = false;
  news_.notify_all();
  // Outside the lock: a reader may poll from within.
  for (const auto& reader : readers) reader(now);
  return now;
}

void UpdateFeed::restart() { restart_ = true; }

UpdateFeed::Update UpdateFeed::latest() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return latest_;
}

// Unites the rectangles of the missed updates. If the oldest of them is gone, everything counts as
// changed.
UpdateFeed::Update UpdateFeed::since_locked(std::uint64_t seen) const {
  if (!latest_ || latest_->sequence == seen) return nullptr;
  if (latest_->since == seen && seen != 0) return latest_;
  MapUpdate out = *latest_;
  // What it missed must be in the list from its first step on.
  // Steps are numbered without gaps, so having the first one means having them all.
  const bool known = seen > 0 && seen < latest_->sequence && !steps_.empty() &&
                     steps_.front().sequence <= seen + 1;
  out.since = known ? seen : 0;
  heightfield::RectList all;
  if (!known) all.add(out.map.rect());
  for (const PastUpdate& step : steps_)
    if (known && step.sequence > seen)
      for (const CellRect& rect : step.rects) all.add(rect);
  out.rects = all.rects();
  // A column may have changed in several of them, so the count is an upper bound.
  out.changed = known ? std::min(area_of(out.rects), out.map.rect().area()) : out.map.rect().area();
  out.merged = known;
  return std::make_shared<const MapUpdate>(std::move(out));
}

UpdateFeed::Update UpdateFeed::since(std::uint64_t seen) const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return since_locked(seen);
}

// The answer is computed under the lock, so that no update is missed between waiting and reading.
UpdateFeed::Update UpdateFeed::wait(std::uint64_t seen, double seconds) const {
  std::unique_lock<std::mutex> lock(mutex_);
  Update out;
  // `wait_for` evaluates the condition before it waits, so a result that is there is returned at
  // once.
  news_.wait_for(lock, std::chrono::duration<double>(seconds), [&] {
    out = since_locked(seen);
    return closed_ || out != nullptr;
  });
  return out;
}

void UpdateFeed::subscribe(std::function<void(const Update&)> reader) {
  const std::lock_guard<std::mutex> lock(mutex_);
  readers_.push_back(std::move(reader));
}

// Subscribers are dropped, because they may refer to objects that are destroyed next.
void UpdateFeed::close() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    closed_ = true;
    readers_.clear();
  }
  news_.notify_all();
}

bool UpdateFeed::closed() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return closed_;
}

}  // namespace navvy::map
