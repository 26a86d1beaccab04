// SPDX-License-Identifier: Apache-2.0
// Who asks often gets exact answers, who asks seldom a bounding one, and nobody has to be known by name.
#include "heightfield/change_log.h"

#include <algorithm>

namespace navvy::heightfield {
namespace {

// Memory bound (64 KiB) against exactness: some seconds of digging keep their rectangles
constexpr std::size_t kMostEdits = 2048;

}  // namespace

void ChangeLog::add(int ix, int iy) {
  ++sequence_;
  // The same column edited again (take then put, layer by layer) extends its own entry.
  if (!edits_.empty()) {
    const CellRect& r = edits_.back().rect;
    if (r.x0 == ix && r.y0 == iy && r.x1 == ix + 1 && r.y1 == iy + 1) {
      edits_.back().last = sequence_;
      return;
    }
  }
  // Full: pairs in the older half are united, which frees a quarter at once and keeps the cost per edit constant.
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
  // From the newest back, as questions are mostly about the last step.
  CellRect rect;
  for (auto edit = edits_.rbegin(); edit != edits_.rend() && edit->last > sequence; ++edit) rect.include(edit->rect);
  return rect;
}

void ChangeLog::save(StateWriter& writer) const {
  writer.value(sequence_);
  writer.vector(edits_);
}

void ChangeLog::load(StateReader& reader) {
  sequence_ = reader.value<std::uint64_t>();
  edits_ = reader.vector<Edit>();
}

}  // namespace navvy::heightfield
