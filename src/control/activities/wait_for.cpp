// SPDX-License-Identifier: Apache-2.0
#include "control/activities/wait_for.h"

#include "control/activity.h"
#include "control/reach.h"

namespace navvy::control {
namespace {

// Reads the other program's progress as it was at the start of the control step, whatever the
// machines' order.
class WaitingFor final : public Activity {
 public:
  WaitingFor(OperatorContext& place, const WaitFor& step) : Activity(place), step_(step) {}
  const char* phase() const override { return "wait_for"; }
  void begin(const Observation&) override {}

 private:
  bool update(const Observation& seen, double, Command&) override {
    const ProgramProgress* other = nullptr;
    if (seen.programs) {
      const auto found = seen.programs->find(step_.machine);
      if (found != seen.programs->end()) other = &found->second;
    }
    // The loader knows the machine, but it may be in a world built in C++.
    if (!other)
      return fall_short(StepState::kBlocked, "no program of '" + step_.machine + "' is known");
    // 0 means all steps, however many the other program has.
    const int wanted = step_.steps > 0 ? step_.steps : other->steps;
    if (other->done >= wanted) return true;
    const std::string stands = "'" + step_.machine + "' has done " + std::to_string(other->done) +
                               " of the " + std::to_string(wanted) + " steps waited for";
    if (other->failed)
      return fall_short(StepState::kBlocked, stands + ", and its program has ended");
    if (phase_time() < step_.longest) return false;
    return fall_short(StepState::kOutOfTime, stands + " after " + number_text(step_.longest, "s"));
  }

  const WaitFor& step_;
};

}  // namespace

std::unique_ptr<Activity> WaitFor::activity(OperatorContext& place) const {
  return std::make_unique<WaitingFor>(place, *this);
}

}  // namespace navvy::control
