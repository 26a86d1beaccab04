// SPDX-License-Identifier: Apache-2.0
// Keeps a list of rectangles short without covering many columns that no one added.
#include "heightfield/cell_rect.h"

#include <algorithm>
#include <limits>

namespace navvy::heightfield {
namespace {

// Columns of the union that are in neither: a reader of the list would renew them for nothing.
std::int64_t added_area(const CellRect& a, const CellRect& b) {
  CellRect both = a;
  both.include(b);
  return both.area() - a.area() - b.area() + a.cut(b).area();
}

// Cost of an entry without a partner: more than any union adds.
constexpr std::int64_t kNone = std::numeric_limits<std::int64_t>::max();

}  // namespace

// The result may be empty or inverted; `empty` handles both.
CellRect CellRect::cut(const CellRect& other) const {
  return {std::max(x0, other.x0), std::max(y0, other.y0), std::min(x1, other.x1),
          std::min(y1, other.y1)};
}

// An empty rectangle has no place, so it changes nothing.
void CellRect::include(const CellRect& other) {
  if (other.empty()) return;
  if (empty()) {
    *this = other;
    return;
  }
  x0 = std::min(x0, other.x0);
  y0 = std::min(y0, other.y0);
  x1 = std::max(x1, other.x1);
  y1 = std::max(y1, other.y1);
}

// Updates both directions in one pass: an entry that was added or grew may be a better partner for
// others.
void RectList::find_partner(std::size_t i) {
  entries_[i].added = kNone;
  for (std::size_t k = 0; k < entries_.size(); ++k) {
    if (k == i) continue;
    const std::int64_t added = added_area(entries_[i].rect, entries_[k].rect);
    if (added < entries_[i].added) entries_[i].partner = k, entries_[i].added = added;
    if (added < entries_[k].added) entries_[k].partner = i, entries_[k].added = added;
  }
}

// Entries whose partner was i search for a new one; entries whose partner was the last one follow
// it to its new place.
void RectList::erase(std::size_t i) {
  const std::size_t last = entries_.size() - 1;
  // Indices after the move.
  std::vector<std::size_t> lonely;
  for (std::size_t k = 0; k < last; ++k) {
    const Entry& entry = entries_[k == i ? last : k];
    if (entry.partner == i) lonely.push_back(k);
  }
  entries_[i] = entries_[last];
  entries_.pop_back();
  for (Entry& entry : entries_)
    if (entry.partner == last) entry.partner = i;
  for (const std::size_t k : lonely) find_partner(k);
}

// Completes larger rectangles first, because that covers nothing in excess; unites only when the
// list is full.
void RectList::add(const CellRect& rect) {
  if (rect.empty()) return;
  // Rectangles that complete a larger one with the new rectangle become part of it, which may allow
  // further unions.
  CellRect grown = rect;
  for (std::size_t i = 0; i < entries_.size();) {
    if (added_area(entries_[i].rect, grown) > 0) {
      ++i;
      continue;
    }
    grown.include(entries_[i].rect);
    erase(i);
    i = 0;
  }
  entries_.push_back({grown, 0, kNone});
  find_partner(entries_.size() - 1);
  if (entries_.size() <= kMost) return;
  // The pair whose union costs its readers least is removed, and the union is added like any other
  // rectangle, so that it too can complete a larger one.
  const auto least =
      std::min_element(entries_.begin(), entries_.end(),
                       [](const Entry& a, const Entry& b) { return a.added < b.added; });
  const auto a = static_cast<std::size_t>(least - entries_.begin()), b = least->partner;
  CellRect united = entries_[a].rect;
  united.include(entries_[b].rect);
  // Removed from the back, so that the first index stays valid.
  erase(std::max(a, b));
  erase(std::min(a, b));
  add(united);
}

std::vector<CellRect> RectList::rects() const {
  std::vector<CellRect> out;
  out.reserve(entries_.size());
  for (const Entry& entry : entries_) out.push_back(entry.rect);
  return out;
}

}  // namespace navvy::heightfield
