// SPDX-License-Identifier: Apache-2.0
// Records which columns changed after which sequence number.
#pragma once

#include <cstdint>
#include <vector>

#include "heightfield/cell_rect.h"

namespace navvy {
class Archive;
}

namespace navvy::heightfield {

/// A bounded list of edits, oldest first. Recent edits keep their own rectangle. When the list is
/// full, neighbours in its older half are united, so that a query about the distant past returns a
/// bounding superset. Adding an edit costs amortised O(1).
class ChangeLog {
 public:
  /// Records one edit of column (ix, iy). Consecutive edits of one column share an entry.
  void add(int ix, int iy);
  /// Returns the number of edits so far.
  std::uint64_t sequence() const { return sequence_; }
  /// Returns the rectangle that changed after `sequence`, or `everything` when `sequence` lies in
  /// the future, as it does after a snapshot was loaded.
  CellRect since(std::uint64_t sequence, const CellRect& everything) const;

  /// Returns true when all edits lie in `site`. Loading code checks a log with it.
  bool lies_in(const CellRect& site) const;

  /// Visits the whole log, because the next exchange of the soil depends on it.
  /// @throws InputError for edits that no log can hold.
  void visit(Archive& a);

  /// One or several consecutive edits.
  struct Edit {
    /// Newest sequence number of the entry.
    std::uint64_t last = 0;
    /// Columns of the entry; never empty.
    CellRect rect;
  };

 private:
  std::vector<Edit> edits_;
  std::uint64_t sequence_ = 0;
};

}  // namespace navvy::heightfield
