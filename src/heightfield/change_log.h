// SPDX-License-Identifier: Apache-2.0
// Records which columns were edited after a given sequence number.
#pragma once

#include <cstdint>
#include <vector>

#include "heightfield/cell_rect.h"

namespace navvy {
class Archive;
}

namespace navvy::heightfield {

/// A list of column edits with a bounded length, oldest first.
///
/// Recent edits have their own rectangles. If the list is full, neighbouring entries in its older
/// half are merged, so a query about the distant past returns a rectangle that is larger than
/// necessary. Adding an edit takes amortised constant time.
class ChangeLog {
 public:
  /// Records one edit of column (ix, iy) and increases the sequence number by 1. Consecutive edits
  /// of the same column share one entry.
  void add(int ix, int iy);
  /// Returns the sequence number of the latest edit, which equals the number of edits so far.
  std::uint64_t sequence() const { return sequence_; }
  /// Returns the bounding rectangle of all columns edited after sequence number `sequence`; empty
  /// if there are none. Returns `everything` if `sequence` is larger than the current sequence
  /// number, which happens after an earlier state was loaded.
  CellRect since(std::uint64_t sequence, const CellRect& everything) const;

  /// Returns true if all recorded edits lie within `site`. Used to validate a loaded log.
  bool lies_in(const CellRect& site) const;

  /// Saves or loads the whole log. It is part of a snapshot because the soil uses it to decide
  /// which columns to exchange next.
  /// @throws InputError when loading entries that a log cannot contain.
  void visit(Archive& a);

  /// One entry of the log: one edit, or several merged ones.
  struct Edit {
    /// Sequence number of the latest edit in this entry.
    std::uint64_t last = 0;
    /// Bounding rectangle of the edited columns; never empty.
    CellRect rect;
  };

 private:
  /// Entries of the log, in ascending order of Edit::last.
  std::vector<Edit> edits_;
  /// Number of edits so far.
  std::uint64_t sequence_ = 0;
};

}  // namespace navvy::heightfield
