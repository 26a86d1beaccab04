// SPDX-License-Identifier: Apache-2.0
// The heap from which a step takes soil, as a scene describes it. Private to the dig.
#pragma once

#include <vector>

#include "control/activity_step.h"
#include "control/job_planner.h"

namespace navvy::control {

/// Elements of a step that takes soil from a heap or windrow.
struct HeapSource {
  /// Ends (x, y) in W of the centre line of the heap [m].
  Vec2 from = Vec2::Zero(), to = Vec2::Zero();
  /// True if the scene file gives `to`; without it the heap is a square about `from`.
  bool has_to = false;
  /// Width of the strip from which the soil is taken [m].
  double width = 4;

  /// Lists the elements.
  void describe(scene::Fields& f) {
    f("from_m", from, {-1e6, 1e6}, "Place of the heap in W.", scene::kNeeded);
    f("from_to_m", to, {-1e6, 1e6},
      "Other end of a windrow that begins at from_m; without it the heap is a square.",
      scene::given(has_to));
    f("heap_width_m", width, {1, 20}, "Width of the strip of soil that is taken.");
  }
  /// Reports an error for a heap off the site.
  void check(const scene::StepSource& source) const {
    source.on_site("from_m", from);
    if (has_to) source.on_site("from_to_m", to);
  }
  /// Returns the heap.
  JobHeap heap() const { return {from, has_to ? to : from, width}; }
  /// Returns its ends.
  std::vector<Vec2> places() const {
    return has_to ? std::vector<Vec2>{from, to} : std::vector<Vec2>{from};
  }
};

}  // namespace navvy::control
