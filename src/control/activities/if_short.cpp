// SPDX-License-Identifier: Apache-2.0
#include "control/activities/if_short.h"

#include <string>

#include "control/activity.h"
#include "control/reach.h"

namespace navvy::control {
namespace {

// Without state: the operator knows what fell short.
class Branching final : public Activity {
 public:
  Branching(OperatorContext& place, const IfShort& step) : Activity(place), step_(step) {}
  const char* phase() const override { return "if_short"; }
  void begin(const Observation&) override {}

 private:
  bool update(const Observation&, double, Command&) override {
    if (place_.fell_short) {
      remark("a step before it fell short");
      return true;
    }
    remark("nothing fell short");
    skip(step_.steps);
    return true;
  }

  const IfShort& step_;
};

}  // namespace

std::unique_ptr<Activity> IfShort::activity(OperatorContext& place) const {
  return std::make_unique<Branching>(place, *this);
}

void IfShort::check_reach(ReachCheck& check) const {
  if (check.steps_before() == 0)
    check.fault("if_short", "", "no step before it can fall short", "put it after such a step");
  if (static_cast<std::size_t>(steps) > check.steps_after())
    check.fault("if_short/steps", std::to_string(steps),
                "the program has " + std::to_string(check.steps_after()) + " steps after this one",
                "run at most so many");
}

}  // namespace navvy::control
