// SPDX-License-Identifier: Apache-2.0
// Windows overlap by one row and one column, so that the four cells of a bilinear height are in one
// window. Each thread remembers its last few windows and takes the lock only for another one.
#include "heightfield/windowed_raster.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cmath>
#include <cstring>
#include <deque>
#include <mutex>
#include <unordered_map>
#include <utility>

#include "core/hash.h"
#include "heightfield/raster_cells.h"

namespace navvy::heightfield {
namespace {

/// Rows that a pass over the map reads at once: whole blocks of most files.
constexpr int kPassRows = 256;
/// Bits of a float that a histogram of tangents omits: 2^23 counters, 32 MB.
constexpr int kLeftOut = 8;

/// Computes StateHash::bytes of an array that comes in parts.
class HashInParts {
 public:
  explicit HashInParts(std::uint64_t size) { hash_.value(size); }
  void add(const float* values, std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) {
      const auto bits = std::bit_cast<std::uint32_t>(values[i]);
      // Eight bytes at a time, the first of them lowest.
      if (waits_) hash_.value(first_ | static_cast<std::uint64_t>(bits) << 32);
      first_ = bits;
      waits_ = !waits_;
    }
  }
  StateHash& end() {
    // An odd number of floats leaves four bytes, which StateHash::bytes adds one by one.
    for (int byte = 0; waits_ && byte < 4; ++byte)
      hash_.value(static_cast<std::uint8_t>(first_ >> (8 * byte)));
    waits_ = false;
    return hash_;
  }

 private:
  StateHash hash_;
  std::uint64_t first_ = 0;
  bool waits_ = false;
};

// Numbers are never reused, so that the memory of a thread cannot mistake one map for another.
std::uint64_t next_number() {
  static std::atomic<std::uint64_t> number{0};
  return ++number;
}

}  // namespace

struct WindowedRaster::Window {
  int x0 = 0, y0 = 0, width = 0;
  std::vector<float> z;
  float at(int ix, int iy) const {
    return z[static_cast<std::size_t>(iy - y0) * static_cast<std::size_t>(width) +
             static_cast<std::size_t>(ix - x0)];
  }
};

struct WindowedRaster::Cache {
  // Identifies the windows of this map in the memory of threads.
  const std::uint64_t number = next_number();
  std::mutex mutex;
  std::unordered_map<std::int64_t, std::shared_ptr<const Window>> windows;
  std::deque<std::int64_t> order;  // as they came in
};

WindowedRaster::WindowedRaster(const HeightRaster& frame, Source source, int side)
    : frame_(frame),
      source_(std::move(source)),
      side_(side),
      across_((frame.nx + side - 1) / side),
      cache_(std::make_unique<Cache>()) {}

WindowedRaster::~WindowedRaster() = default;

// Gaps are sorted, so a binary search within the row finds one.
std::int64_t WindowedRaster::gap_at(int ix, int iy) const {
  if (row_begin_.empty()) return -1;
  const auto begin = gaps_.begin() + row_begin_[static_cast<std::size_t>(iy)];
  const auto end = gaps_.begin() + row_begin_[static_cast<std::size_t>(iy) + 1];
  const std::int64_t wanted = static_cast<std::int64_t>(iy) * frame_.nx + ix;
  const auto found = std::lower_bound(begin, end, wanted);
  return found != end && *found == wanted ? found - gaps_.begin() : -1;
}

// Reads from the file and then overwrites the gaps.
void WindowedRaster::read(const CellRect& cells, float* out) const {
  source_(cells, out);
  if (row_begin_.empty()) return;
  const auto width = static_cast<std::size_t>(cells.x1 - cells.x0);
  for (int iy = cells.y0; iy < cells.y1; ++iy) {
    const std::int64_t row = static_cast<std::int64_t>(iy) * frame_.nx;
    const auto end = gaps_.begin() + row_begin_[static_cast<std::size_t>(iy) + 1];
    for (auto gap = std::lower_bound(gaps_.begin() + row_begin_[static_cast<std::size_t>(iy)], end,
                                     row + cells.x0);
         gap != end && *gap < row + cells.x1; ++gap)
      out[static_cast<std::size_t>(iy - cells.y0) * width +
          static_cast<std::size_t>(*gap - row - cells.x0)] =
          filled_[static_cast<std::size_t>(gap - gaps_.begin())];
  }
}

const WindowedRaster::Window& WindowedRaster::window(int ix, int iy) const {
  struct Recent {
    std::uint64_t number = 0;
    std::int64_t key = 0;
    std::shared_ptr<const Window> window;
  };
  // Four are enough for a mean around the corner of a window, which takes samples from four.
  thread_local std::array<Recent, 4> recent;
  thread_local std::size_t next = 0;
  const int wx = ix / side_, wy = iy / side_;
  const std::int64_t key = static_cast<std::int64_t>(wy) * across_ + wx;
  for (const Recent& each : recent)
    if (each.number == cache_->number && each.key == key) return *each.window;
  // The lock is held while the file is read, because a source serves one thread at a time.
  const std::lock_guard lock(cache_->mutex);
  std::shared_ptr<const Window>& found = cache_->windows[key];
  if (!found) {
    auto made = std::make_shared<Window>();
    const CellRect cells{wx * side_, wy * side_, std::min((wx + 1) * side_ + 1, frame_.nx),
                         std::min((wy + 1) * side_ + 1, frame_.ny)};
    made->x0 = cells.x0;
    made->y0 = cells.y0;
    made->width = cells.x1 - cells.x0;
    made->z.resize(static_cast<std::size_t>(cells.area()));
    read(cells, made->z.data());
    found = std::move(made);
    cache_->order.push_back(key);
  }
  Recent& place = recent[next];
  next = (next + 1) % recent.size();
  place = {cache_->number, key, found};
  // Removes the oldest; threads that use it still hold it.
  if (cache_->order.size() > kMostWindows) {
    cache_->windows.erase(cache_->order.front());
    cache_->order.pop_front();
  }
  return *place.window;
}

GapFill WindowedRaster::fill_gaps(std::vector<std::int64_t> gaps) {
  GapFill result;
  result.gaps = static_cast<std::int64_t>(gaps.size());
  if (gaps.empty()) return result;
  gaps_ = std::move(gaps);
  filled_.assign(gaps_.size(), std::nanf(""));
  row_begin_.resize(static_cast<std::size_t>(frame_.ny) + 1);
  for (int iy = 0; iy <= frame_.ny; ++iy)
    row_begin_[static_cast<std::size_t>(iy)] =
        std::lower_bound(gaps_.begin(), gaps_.end(), static_cast<std::int64_t>(iy) * frame_.nx) -
        gaps_.begin();
  // Windows read meanwhile have gaps where cells are not filled yet: gaps are looked up here first.
  const auto at = [&](int x, int y) {
    const std::int64_t gap = gap_at(x, y);
    return gap >= 0 ? filled_[static_cast<std::size_t>(gap)] : window(x, y).at(x, y);
  };
  const auto place = [&](std::int64_t gap) {
    const std::int64_t cell = gaps_[static_cast<std::size_t>(gap)];
    return std::pair{static_cast<int>(cell % frame_.nx), static_cast<int>(cell / frame_.nx)};
  };
  // Ring by ring as heightfield::fill_gaps does; each ring depends on earlier ones only.
  std::vector<std::int64_t> ring, next;
  std::vector<char> queued(gaps_.size(), 0);
  const auto value = [&](std::int64_t gap) {
    const auto [ix, iy] = place(gap);
    return mean_of_neighbours(frame_, ix, iy, at);
  };
  for (std::int64_t gap = 0; gap < result.gaps; ++gap)
    if (!std::isnan(value(gap))) queued[static_cast<std::size_t>(gap)] = 1, ring.push_back(gap);
  std::vector<float> values;
  // All values of a ring are computed before any is stored, so that their order does not matter.
  while (!ring.empty()) {
    values.clear();
    for (const std::int64_t gap : ring) values.push_back(value(gap));
    for (std::size_t k = 0; k < ring.size(); ++k)
      filled_[static_cast<std::size_t>(ring[k])] = values[k];
    next.clear();
    for (const std::int64_t gap : ring) {
      const auto [ix, iy] = place(gap);
      for (int y = std::max(iy - 1, 0); y <= std::min(iy + 1, frame_.ny - 1); ++y)
        for (int x = std::max(ix - 1, 0); x <= std::min(ix + 1, frame_.nx - 1); ++x) {
          const std::int64_t beside = gap_at(x, y);
          if (beside < 0 || queued[static_cast<std::size_t>(beside)] != 0) continue;
          queued[static_cast<std::size_t>(beside)] = 1;
          next.push_back(beside);
        }
    }
    ring.swap(next);
    ++result.farthest;
  }
  // Earlier windows are wrong in their gaps; a new number makes threads discard theirs.
  cache_ = std::make_unique<Cache>();
  return result;
}

// Slopes go into a histogram, because the tangents of a large map do not fit in memory.
WindowedRaster::Summary WindowedRaster::summary(double limit) const {
  Summary out;
  const auto nx = static_cast<std::size_t>(frame_.nx);
  const std::size_t cells = nx * static_cast<std::size_t>(frame_.ny);
  HashInParts hash(cells * sizeof(float));
  std::vector<std::uint32_t> counts(std::size_t{1} << (31 - kLeftOut), 0);
  float least = INFINITY, most = 0;
  const double steep = std::tan(limit);
  std::uint64_t tangents = 0, above = 0;
  out.least = INFINITY, out.most = -INFINITY;
  // One row more than the strip: the last row of the strip before.
  std::vector<float> rows(nx * (kPassRows + 1));
  for (int y0 = 0; y0 < frame_.ny; y0 += kPassRows) {
    const int count = std::min(kPassRows, frame_.ny - y0);
    float* strip = rows.data() + nx;
    // `read` uses the source, which the lock guards.
    {
      const std::lock_guard lock(cache_->mutex);
      read({0, y0, frame_.nx, y0 + count}, strip);
    }
    hash.add(strip, nx * static_cast<std::size_t>(count));
    const auto [low, high] =
        std::minmax_element(strip, strip + nx * static_cast<std::size_t>(count));
    out.least = std::min(out.least, *low);
    out.most = std::max(out.most, *high);
    // A tangent needs four cells, so the first row of the map has none.
    for (int y = y0 == 0 ? 1 : 0; y < count; ++y) {
      const float *below = strip + nx * static_cast<std::size_t>(y) - nx, *here = below + nx;
      for (std::size_t x = 0; x + 1 < nx; ++x) {
        const float t =
            tangent(frame_, static_cast<double>(below[x]), static_cast<double>(below[x + 1]),
                    static_cast<double>(here[x]), static_cast<double>(here[x + 1]));
        least = std::min(least, t);
        most = std::max(most, t);
        above += static_cast<double>(t) > steep ? 1 : 0;
        // Non-negative floats are ordered like their bits.
        ++counts[std::bit_cast<std::uint32_t>(t) >> kLeftOut];
        ++tangents;
      }
    }
    std::copy(strip + nx * static_cast<std::size_t>(count - 1),
              strip + nx * static_cast<std::size_t>(count), rows.begin());
  }
  StateHash& all = hash.end();
  for (const double one : {frame_.cell_x, frame_.cell_y, frame_.x0, frame_.y0}) all.value(one);
  // The number of rows follows from the size that the hash began with.
  all.value(frame_.nx);
  out.hash = all.digest();
  if (tangents == 0) return out;
  std::uint64_t before = 0;
  std::size_t bucket = 0;
  while (before + counts[bucket] <= tangents / 2) before += counts[bucket++];
  // The middle of the class that holds the median is off by half a class at most, 1 in 65 000.
  const auto middle =
      static_cast<std::uint32_t>(bucket << kLeftOut | std::size_t{1} << (kLeftOut - 1));
  out.slope.median = std::atan(std::bit_cast<float>(middle));
  out.slope.least = std::atan(least);
  out.slope.most = std::atan(most);
  out.slope.share_above = static_cast<double>(above) / static_cast<double>(tangents);
  return out;
}

double WindowedRaster::mean(double x, double y, double edge) const {
  const auto sample = [&](double px, double py) {
    return bilinear(frame_, px, py, [&](int ix, int iy, int jx, int jy, float* corners) {
      const Window& in = window(ix, iy);
      corners[0] = in.at(ix, iy), corners[1] = in.at(jx, iy), corners[2] = in.at(ix, jy),
      corners[3] = in.at(jx, jy);
    });
  };
  return mean_of_samples(frame_, x, y, edge, sample);
}

}  // namespace navvy::heightfield
