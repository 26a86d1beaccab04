// SPDX-License-Identifier: Apache-2.0
#include "control/activities/wait_for.h"

#include "control/activity.h"
#include "core/log.h"

namespace navvy::control {
namespace {

// Reads the other program's progress as it stood at the start of the control step, whatever the machines' order.
class WaitingFor final : public Activity {
 public:
  WaitingFor(Workplace& place, const WaitFor& step) : Activity(place), step_(step) {}
  const char* phase() const override { return "wait_for"; }
  void begin(const Observation&) override {}

 private:
  bool update(const Observation& seen, double, Command&) override {
    const ProgramProgress* other = nullptr;
    if (seen.programs) {
      const auto found = seen.programs->find(step_.machine);
      if (found != seen.programs->end()) other = &found->second;
    }
    // The loader knows the machine, but it may have left its program for inputs, or stand in a world built in C++.
    if (!other) {
      log_warning("operator: nothing known of '" + step_.machine + "', going on without it");
      return true;
    }
    // 0 stands for all steps, however many the other program has.
    if (other->done >= (step_.steps > 0 ? step_.steps : other->steps)) return true;
    // The other may be stuck: better late than never.
    if (phase_time() < step_.longest) return false;
    log_warning("operator: waited " + std::to_string(phase_time()) + " s for '" + step_.machine + "', going on");
    return true;
  }

  const WaitFor& step_;
};

}  // namespace

WaitFor WaitFor::read(const scene::StepSource& source) {
  // Whether there is such a machine, with so many steps, is asked when all programs have been read.
  WaitFor step;
  source.fields.text("machine", step.machine)
      .required("machine")
      .whole("steps", step.steps, {1, 1e6})
      .number("longest_s", step.longest, {0, 1e6})
      .finish();
  return step;
}

std::unique_ptr<Activity> WaitFor::activity(Workplace& place) const {
  return std::make_unique<WaitingFor>(place, *this);
}

}  // namespace navvy::control
