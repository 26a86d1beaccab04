// SPDX-License-Identifier: Apache-2.0
// The program step `load`: loads trucks from a heap or windrow.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "control/activities/dig/dig_area.h"
#include "control/activities/dig/heap_source.h"

namespace navvy::control {

/// Loads the beds of trucks with soil from a heap or windrow, from the place where the machine
/// stands. It waits until a truck stands within reach, spreads its passes along the bed up to the
/// commanded mass, and goes on with the next truck.
///
/// The step is done after a number of loads. It falls short if the heap gives no more soil, or if
/// no truck comes in time.
struct LoadTrucks final : DigArea {
  /// Name of the step's element in scene files.
  static constexpr const char* kElement = "load";
  /// One-sentence description of the step for the reference of scene elements.
  static constexpr const char* kText =
      "Loads one or more trucks with soil from a heap or windrow, and waits for them.";
  /// Digs no area. tuned: from a heap 1.8 m high, layers of at most 0.5, 0.7 and 1.2 m bring 655,
  /// 827 and, with more than a bucket can hold at times, 990 kg a scoop.
  LoadTrucks() {
    depth = 0;
    pass_depth = 0.7;
  }
  /// Source of the soil.
  HeapSource source;

  /// Lists the child elements of the step with their ranges and descriptions.
  void describe(scene::Fields& f) override {
    source.describe(f);
    f("dump_at_m", dump_at, {-1e6, 1e6}, "Place in W at which the beds stand.", scene::kNeeded);
    f("dump_height_m", dump_height, {0.1, 10},
      "Least height of the tip over the ground there; in any case it clears the rim.");
    f("loads", loads, {1, 10000}, "Number of trucks to load; by default one.");
    describe_trucks(f, scene::kNeeded);
    f("pass_depth_m", pass_depth, {0.1, 5}, "Largest depth of a layer of the heap.");
    describe_fill(f);
  }
  /// Reports an error if the machine cannot dig, and for places off the site.
  void check(const scene::StepSource& read) {
    loads = loads.value_or(1);
    DigArea::check(read);
    source.check(read);
    heap = source.heap();
  }
  /// Returns the name of the step's element in scene files.
  const char* element() const override { return kElement; }
  /// Returns the ends of the windrow and the place of the beds.
  std::vector<Vec2> places() const override {
    std::vector<Vec2> out = source.places();
    out.push_back(dump_at);
    return out;
  }
  /// Returns false: the machine stays where it stands.
  bool needs_planner() const override { return false; }
  /// Returns nothing: the step digs no pit.
  std::optional<PitJob> pit_job() const override { return std::nullopt; }
};

}  // namespace navvy::control
