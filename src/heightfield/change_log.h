// SPDX-License-Identifier: Apache-2.0
// Which columns changed after which sequence number.
#pragma once

#include <cstdint>
#include <vector>

#include "heightfield/cell_rect.h"

namespace navvy {
class Archive;
}

namespace navvy::heightfield {

/// A bounded list of edits, oldest first. Recent edits keep their own rectangle; when the list is
/// full, neighbours in its older half are united, so a question about long ago gets a bounding
/// superset. Adding costs amortised O(1).
class ChangeLog {
 public:
  /// Counts one edit of column (ix, iy). Edits of the same column in a row share an entry.
  void add(int ix, int iy);
  /// Number of edits so far.
  std::uint64_t sequence() const { return sequence_; }
  /// Rectangle changed after `sequence`; `everything` when `sequence` lies in the future (a
  /// snapshot was loaded).
  CellRect since(std::uint64_t sequence, const CellRect& everything) const;

  /// Whether all edits lie in `site`; for who loads a log.
  bool lies_in(const CellRect& site) const;

  /// All of it, as the soil's next look at what changed depends on it. @throws InputError for edits
  /// that no log has.
  void visit(Archive& a);

  struct Edit {
    std::uint64_t last = 0;  ///< newest sequence number in here
    CellRect rect;           ///< never empty
  };

 private:
  std::vector<Edit> edits_;
  std::uint64_t sequence_ = 0;
};

}  // namespace navvy::heightfield
