// SPDX-License-Identifier: Apache-2.0
// Maps share their tiles, so an update is a few pointers: publishing copies nothing and readers lock for a moment only.
#include "planner/updates.h"

#include <algorithm>
#include <array>
#include <bit>
#include <chrono>
#include <utility>

#include "planner/formats/json_text.h"

namespace navvy::planner {
namespace {

using heightfield::CellRect;

/// Columns of one tile of which any layer differs.
std::int64_t changed_in(const TerrainMap& a, const TerrainMap& b, const CellRect& tile) {
  // Nearly all tiles are those of before, in every layer: told by their first rows, without the other 63.
  const bool shared = std::all_of(layers().begin(), layers().end(), [&](const LayerInfo& each) {
    int run = 0;
    return !b.has(each.layer) ||
           a.tiles(each.layer).row(tile.x0, tile.y0, run) == b.tiles(each.layer).row(tile.x0, tile.y0, run);
  });
  if (shared) return 0;
  std::array<bool, LayerTiles::kSide> differs{};
  std::int64_t count = 0;
  for (int iy = tile.y0; iy < tile.y1; ++iy) {
    differs.fill(false);
    for (const LayerInfo& each : layers()) {
      if (!b.has(each.layer)) continue;
      int run = 0;
      const float* p = a.tiles(each.layer).row(tile.x0, iy, run);
      const float* q = b.tiles(each.layer).row(tile.x0, iy, run);
      // One tile for both: nothing of it was written to.
      if (p == q) continue;
      for (int ix = 0; ix < tile.x1 - tile.x0; ++ix) {
        const float u = p != nullptr ? p[ix] : kUnknown, v = q != nullptr ? q[ix] : kUnknown;
        if (std::bit_cast<std::uint32_t>(u) != std::bit_cast<std::uint32_t>(v))
          differs[static_cast<std::size_t>(ix)] = true;
      }
    }
    count += std::count(differs.begin(), differs.end(), true);
  }
  return count;
}

std::int64_t area_of(const std::vector<CellRect>& rects) {
  std::int64_t area = 0;
  for (const CellRect& rect : rects) area += rect.area();
  return area;
}

}  // namespace

std::int64_t count_changed(const TerrainMap& before, const TerrainMap& after) {
  std::int64_t count = 0;
  constexpr int kSide = LayerTiles::kSide;
  for (int y0 = 0; y0 < after.ny(); y0 += kSide)
    for (int x0 = 0; x0 < after.nx(); x0 += kSide)
      count += changed_in(before, after, CellRect{x0, y0, x0 + kSide, y0 + kSide}.cut(after.rect()));
  return count;
}

UpdateFeed::UpdateFeed(MapOptions options) : maker_(std::move(options)) {}

UpdateFeed::Update UpdateFeed::publish(const heightfield::TerrainView& view) {
  const std::vector<CellRect>& rects = maker_.update(view);
  const Update before = latest();
  MapUpdate update{0, before ? before->sequence + 1 : 1, view.time(), rects, 0, false, maker_.map()};
  const bool same_site = before && before->map.nx() == update.map.nx() && before->map.ny() == update.map.ny();
  update.since = same_site ? before->sequence : 0;
  update.changed = same_site ? count_changed(before->map, update.map) : update.map.rect().area();
  if (same_site && update.changed == 0) return before;
  update.merged = area_of(update.rects) > 2 * update.changed;
  auto now = std::make_shared<const MapUpdate>(std::move(update));
  std::vector<std::function<void(const Update&)>> readers;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (closed_) return before;
    if (!same_site) steps_.clear();
    steps_.push_back({now->sequence, now->rects});
    if (steps_.size() > kKept) steps_.pop_front();
    latest_ = now;
    readers = readers_;
  }
  news_.notify_all();
  // Outside the lock: a reader may poll from within.
  for (const auto& reader : readers) reader(now);
  return now;
}

UpdateFeed::Update UpdateFeed::latest() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return latest_;
}

UpdateFeed::Update UpdateFeed::since_locked(std::uint64_t seen) const {
  if (!latest_ || latest_->sequence == seen) return nullptr;
  if (latest_->since == seen && seen != 0) return latest_;
  MapUpdate out = *latest_;
  // What it missed must be in the list from its first step on.
  const bool known = seen > 0 && seen < latest_->sequence && !steps_.empty() && steps_.front().sequence <= seen + 1;
  out.since = known ? seen : 0;
  heightfield::RectList all;
  if (!known) all.add(out.map.rect());
  for (const Step& step : steps_)
    if (known && step.sequence > seen)
      for (const CellRect& rect : step.rects) all.add(rect);
  out.rects = all.rects();
  // A column may have changed in several of them: what is told is an upper bound.
  out.changed = known ? std::min(area_of(out.rects), out.map.rect().area()) : out.map.rect().area();
  out.merged = known;
  return std::make_shared<const MapUpdate>(std::move(out));
}

UpdateFeed::Update UpdateFeed::since(std::uint64_t seen) const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return since_locked(seen);
}

UpdateFeed::Update UpdateFeed::wait(std::uint64_t seen, double seconds) const {
  std::unique_lock<std::mutex> lock(mutex_);
  Update out;
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

std::vector<char> patch_bytes(const MapUpdate& update, const std::vector<Layer>& wanted) {
  const TerrainMap& map = update.map;
  std::string head = "{\"format\": 1, \"since\": " + std::to_string(update.since) +
                     ", \"sequence\": " + std::to_string(update.sequence) +
                     ", \"time_s\": " + json_number(update.time) + ", \"nx\": " + std::to_string(map.nx()) +
                     ", \"ny\": " + std::to_string(map.ny()) + ", \"cell_m\": " + json_number(map.cell()) +
                     ", \"origin_m\": [" + json_number(map.origin().x()) + ", " + json_number(map.origin().y()) +
                     "], \"changed\": " + std::to_string(update.changed) +
                     ", \"merged\": " + (update.merged ? "true" : "false") + ", \"layers\": [";
  for (std::size_t i = 0; i < wanted.size(); ++i) head += (i > 0 ? ", " : "") + json_string(info(wanted[i]).name);
  head += "], \"rects\": [";
  for (std::size_t i = 0; i < update.rects.size(); ++i) {
    const CellRect& r = update.rects[i];
    head += (i > 0 ? ", [" : "[") + std::to_string(r.x0) + ", " + std::to_string(r.y0) + ", " + std::to_string(r.x1) +
            ", " + std::to_string(r.y1) + "]";
  }
  head += "]}";
  // Numbers begin at a multiple of 4.
  head.append((4 - head.size() % 4) % 4, ' ');
  const auto length = static_cast<std::uint32_t>(head.size());
  std::string begin = "NAVVYMAP";
  for (int i = 0; i < 4; ++i) begin += static_cast<char>(length >> (8 * i) & 0xFF);
  begin += head;
  std::vector<char> out(begin.begin(), begin.end());
  for (const CellRect& rect : update.rects)
    for (const Layer layer : wanted) {
      const std::vector<float> values = map.copy(layer, rect);
      const char* first = reinterpret_cast<const char*>(values.data());
      out.insert(out.end(), first, first + values.size() * sizeof(float));
    }
  return out;
}

}  // namespace navvy::planner
