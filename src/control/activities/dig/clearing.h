// SPDX-License-Identifier: Apache-2.0
// The activity that carries out a clear step. Private to the dig.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "control/activities/dig/clear.h"
#include "control/activities/dig/clear_strip.h"
#include "control/activities/dig/dig.h"
#include "control/activities/part.h"
#include "control/activity.h"

namespace navvy::control {

/// A body that a clear step takes away.
struct ClearTarget {
  /// Name of the body in the scene.
  std::string name;
  /// Number of scoops made for it so far.
  std::int64_t tries = 0;
  /// Reason why the last one did not clear it; empty before the first.
  std::string trouble;

  /// Saves or loads all fields.
  void visit(Archive& a);
};

/// State of a clear step, except that of the scoop that runs.
struct ClearMemory {
  /// Bodies that were in the polygon when the step began.
  std::vector<ClearTarget> targets;
  /// Index of the body that the present or last scoop is for.
  std::int64_t aim = 0;
  /// Strip of that scoop.
  ClearStrip strip;
  /// Height of the bucket's tip above the ground at the dump [m].
  double dump_height = 0;
  /// True if the body was in the bucket when that left the ground.
  bool taken = false;

  /// Saves or loads all fields.
  void visit(Archive& a);
};

/// Activity that carries out a clear: for one body after the other makes a scoop along a strip of
/// ground, by a dig of one pass, and looks where the body lies then.
class Clearing final : public ActivityWith<ClearMemory> {
 public:
  /// Makes the activity of the step `step`. The step and `place` must outlive it; `place` must have
  /// an arm.
  Clearing(OperatorContext& place, const Clear& step) : ActivityWith(place), step_(step) {}

  /// Lists the bodies in the polygon.
  void begin(const Observation& seen) override;
  /// Returns the name of the phase of the running scoop.
  const char* phase() const override;
  /// Returns the numbers of bodies, of those that are cleared and left, of scoops, and the largest
  /// distance of a cleared body from the place.
  std::vector<Measurement> account(const Observation& seen) const override;
  /// Saves or loads the state and the running scoop.
  void visit(Archive& a) override;

 private:
  // A scoop runs in kScoop only.
  enum Phase : std::int64_t { kNext, kScoop, kRest };

  /// Advances the running scoop. Returns true when the step is over.
  bool update(const Observation& seen, double dt, Command& out) override;
  /// Begins the next scoop. Returns true when there is none.
  bool go_on(const Observation& seen);
  /// Selects the body that is taken next, with its strip; returns false if none can be.
  bool select(const Observation& seen);
  /// Returns true while the body still moves after the dump, for some seconds at most.
  bool is_moving(const Observation& seen) const;
  /// Notes what became of the body after a scoop.
  void judge(const Observation& seen, const std::string& failure);
  /// Returns true if the bucket holds the body.
  bool is_held(const Observation& seen) const;
  /// Returns true if a body is in the bucket.
  bool holds(const Observation& seen, const BodyView& body) const;
  /// Returns true if the body is outside the polygon, near the place and not in the bucket.
  bool is_cleared(const Observation& seen, const BodyView& body) const;
  /// Sets the result of the step by the bodies that are left. Always returns true.
  bool conclude(const Observation& seen);
  /// Returns the height of the bucket's tip over the ground at the dump, above what lies there.
  double height_of_dump(const Observation& seen, const std::vector<BodyView>& bodies) const;
  /// Makes step and activity of the present scoop, whose state is new.
  void make_part();
  /// Returns the present target.
  ClearTarget& target() { return m.targets[static_cast<std::size_t>(m.aim)]; }
  const ClearTarget& target() const { return m.targets[static_cast<std::size_t>(m.aim)]; }

  // The step that is carried out.
  const Clear& step_;
  Part part_;
};

}  // namespace navvy::control
