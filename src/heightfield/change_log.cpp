// SPDX-License-Identifier: Apache-2.0
// Frequent readers get exact answers and rare ones a bounding rectangle, without registration.
#include "heightfield/change_log.h"

#include <algorithm>

#include "core/archive.h"

// A full log has 48 KiB and is saved and hashed in one run: a number of 8 bytes and four of 4 leave
// no padding.
static_assert(sizeof(navvy::heightfield::ChangeLog::Edit) ==
              sizeof(std::uint64_t) + 4 * sizeof(int));
template <>
inline constexpr bool navvy::kPlain<navvy::heightfield::ChangeLog::Edit> = true;

namespace navvy::heightfield {
namespace {

// Compromise between memory (64 KiB) and exactness: some seconds of digging keep their rectangles.
constexpr std::size_t kMostEdits = 2048;

}  // namespace

void ChangeLog::add(int ix, int iy) {
  ++sequence_;
  // Another edit of the same column (take then put, layer by layer) extends its entry.
  if (!edits_.empty()) {
    const CellRect& r = edits_.back().rect;
    if (r.x0 == ix && r.y0 == iy && r.x1 == ix + 1 && r.y1 == iy + 1) {
      edits_.back().last = sequence_;
      return;
    }
  }
  // A full list unites pairs in its older half, which frees a quarter at once and keeps the cost
  // per edit constant.
  if (edits_.size() == kMostEdits) {
    for (std::size_t i = 0; i < kMostEdits / 4; ++i) {
      Edit united = edits_[2 * i];
      united.rect.include(edits_[2 * i + 1].rect);
      united.last = edits_[2 * i + 1].last;
      edits_[i] = united;
    }
    edits_.erase(edits_.begin() + kMostEdits / 4, edits_.begin() + kMostEdits / 2);
  }
  edits_.push_back({sequence_, {ix, iy, ix + 1, iy + 1}});
}

CellRect ChangeLog::since(std::uint64_t sequence, const CellRect& everything) const {
  if (sequence > sequence_) return everything;
  // Searches from the newest entry back, because most queries concern the last step.
  CellRect rect;
  for (auto edit = edits_.rbegin(); edit != edits_.rend() && edit->last > sequence; ++edit)
    rect.include(edit->rect);
  return rect;
}

bool ChangeLog::lies_in(const CellRect& site) const {
  return std::all_of(edits_.begin(), edits_.end(), [&](const Edit& edit) {
    return edit.rect.x0 >= site.x0 && edit.rect.y0 >= site.y0 && edit.rect.x1 <= site.x1 &&
           edit.rect.y1 <= site.y1;
  });
}

// Checks what a file could hold and no log can: order, empty rectangles, numbers above the total.
void ChangeLog::visit(Archive& a) {
  a("sequence", sequence_);
  a("edits", edits_);
  if (!a.loading()) return;
  // A longer list would never be shortened, and a query of an unsorted one would stop too early.
  std::uint64_t before = 0;
  bool good = edits_.size() <= kMostEdits;
  for (const Edit& edit : edits_) {
    good = good && edit.last > before && edit.last <= sequence_ && !edit.rect.empty();
    before = edit.last;
  }
  a.require(good, "edits", "must ascend, be no more than are remembered and not be empty");
}

}  // namespace navvy::heightfield
