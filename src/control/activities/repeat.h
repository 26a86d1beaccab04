// SPDX-License-Identifier: Apache-2.0
// The program step `repeat`: runs the steps before it again.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "control/activity_step.h"

namespace navvy::control {

/// Goes back, so that the steps before it run again, until an end is reached: a number of rounds, a
/// simulated time, a volume dug on the site, or a mass in the bed of another machine. If several
/// ends are given, the first one counts. A step that fails in any round ends the program, unless an
/// `if_short` follows.
struct Repeat final : ActivityStep {
  /// Name of the step's element in scene files.
  static constexpr const char* kElement = "repeat";
  /// One-sentence description of the step for the reference of scene elements.
  static constexpr const char* kText = "Runs the steps before it again, until an end is reached.";
  /// Number of steps before this one that are repeated.
  int steps = 1;
  /// Number of rounds in total, with the first one; empty: no limit.
  std::optional<int> times;
  /// Simulated time from which on no round begins [s]; used if `has_until`.
  double until = 0;
  bool has_until = false;
  /// Volume dug on the site from which on no round begins [m3]; used if `has_volume`.
  double volume = 0;
  bool has_volume = false;
  /// Machine whose beds are loaded, and the mass in them at which no round begins [kg]; used if
  /// `has_load`.
  std::string into;
  double load = 0;
  bool has_load = false;

  /// Lists the child elements of the step with their ranges and descriptions.
  void describe(scene::Fields& f) override {
    f("steps", steps, {1, 2000}, "Number of steps before this one that run again.");
    f("times", times, {1, 1e6}, "Number of rounds in total, with the first one.");
    f("until_time_s", until, {0, 1e9}, "Simulated time from which on no round begins.",
      scene::given(has_until));
    f("until_volume_m3", volume, {0.001, 1e9},
      "Volume dug on the site, where it is lower than at the start, from which on no round begins.",
      scene::given(has_volume));
    f("into", into, "Machine whose beds load_kg concerns.");
    f("load_kg", load, {1, 1e6}, "Mass of soil in the beds of `into` at which no round begins.",
      scene::given(has_load));
  }
  /// Reports an error if no end is given, or a mass without its machine or the reverse.
  void check(const scene::StepSource& source);
  /// Returns the name of the step's element in scene files.
  const char* element() const override { return kElement; }
  /// Returns `steps`.
  int repeats() const override { return steps; }
  /// Returns `into`.
  std::vector<std::string> receivers() const override {
    return into.empty() ? std::vector<std::string>{} : std::vector{into};
  }
  /// Returns an activity with one phase, "repeat", which takes one control step.
  std::unique_ptr<Activity> activity(OperatorContext& place) const override;
  /// Reports an error if the program has fewer steps before this one.
  void check_reach(ReachCheck& check) const override;
};

}  // namespace navvy::control
