// SPDX-License-Identifier: Apache-2.0
#include "control/activities/wait.h"

#include "control/activity.h"

namespace navvy::control {
namespace {

// Without state: the clock that every activity has suffices.
class Resting final : public Activity {
 public:
  Resting(OperatorContext& place, const Wait& step) : Activity(place), step_(step) {}
  const char* phase() const override { return "wait"; }
  void begin(const Observation&) override {}

 private:
  // The control step that ends at `duration` is the last.
  bool update(const Observation&, double dt, Command&) override {
    return phase_time() + dt >= step_.duration;
  }

  const Wait& step_;
};

}  // namespace

std::unique_ptr<Activity> Wait::activity(OperatorContext& place) const {
  return std::make_unique<Resting>(place, *this);
}

}  // namespace navvy::control
