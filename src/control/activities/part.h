// SPDX-License-Identifier: Apache-2.0
// An activity that is part of another one. Private to the activities.
#pragma once

#include <cstdint>
#include <memory>
#include <utility>

#include "control/activity.h"
#include "control/activity_step.h"

namespace navvy::control {

/// A step that another step's activity carries out as one of its parts; empty between two parts.
class Part {
 public:
  /// Makes the part that carries out `step`, whose state is new. `place` must outlive it.
  void make(std::unique_ptr<ActivityStep> step, OperatorContext& place) {
    clear();
    step_ = std::move(step);
    activity_ = step_->activity(place);
  }
  /// Ends the part.
  void clear() {
    activity_.reset();
    step_.reset();
  }
  /// Returns true while a part runs.
  explicit operator bool() const { return activity_ != nullptr; }
  /// Returns the activity; requires that a part runs.
  Activity* operator->() const { return activity_.get(); }

  /// Saves or loads the part. `remake` makes the part of the state that was loaded before; it may
  /// require the archive to be sound.
  template <class Remake>
  void visit(Archive& a, const Remake& remake) {
    std::int64_t running = activity_ ? 1 : 0;
    a.ranged("running", running, 0, 1);
    if (a.loading()) {
      clear();
      if (running != 0) remake();
    }
    if (activity_) a("part", *activity_);
  }

 private:
  // The activity refers to the step.
  std::unique_ptr<ActivityStep> step_;
  std::unique_ptr<Activity> activity_;
};

}  // namespace navvy::control
