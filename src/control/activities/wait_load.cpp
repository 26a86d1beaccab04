// SPDX-License-Identifier: Apache-2.0
#include "control/activities/wait_load.h"

#include <string>
#include <vector>

#include "control/activities/dig/landing.h"
#include "control/activity.h"
#include "control/reach.h"
#include "core/error.h"

namespace navvy::control {
namespace {

constexpr double kLookEvery = 0.5;  // [s]; a look costs a pass over the particles
constexpr double kMore = 20;        // mass that counts as more soil [kg]

enum Phase : std::int64_t { kWaiting, kLoaded };

struct Memory {
  double load = 0;   // when soil came last [kg]
  double since = 0;  // time since then [s]
  double next = 0;   // time to the next look [s]

  void visit(Archive& a) {
    a("load", load);
    a("since", since);
    a("next", next);
  }
};

// Looks at its own bed, as a driver does in the mirror.
class WaitingToBeLoaded final : public ActivityWith<Memory> {
 public:
  WaitingToBeLoaded(OperatorContext& place, const WaitLoad& step)
      : ActivityWith(place), step_(step) {}
  const char* phase() const override { return "wait_load"; }
  void begin(const Observation&) override { enter(kWaiting); }
  std::vector<Measurement> account(const Observation& seen) const override {
    if (!seen.bed_load) return {};
    return {{"loaded_kg", seen.bed_load()}};
  }

 private:
  bool update(const Observation& seen, double dt, Command&) override {
    if (phase_index() == kLoaded) return phase_time() >= step_.clear;
    if (!seen.bed_load) return fall_short(StepState::kBlocked, "the load of the bed is unknown");
    m.since += dt;
    m.next -= dt;
    if (m.next > 0) return false;
    m.next = kLookEvery;
    const double load = seen.bed_load();
    if (load > m.load + kMore) {
      m.load = load;
      m.since = 0;
    }
    if (is_loaded(load, step_.load)) {
      enter(kLoaded);
      return false;
    }
    if (m.since < step_.longest) return false;
    const std::string text = "the bed holds " + number_text(load, "kg") + " of " +
                             number_text(step_.load, "kg") + ", and nothing came for " +
                             number_text(m.since, "s");
    if (load < kMore) return fall_short(StepState::kOutOfTime, text);
    remark(text);
    return true;
  }

  const WaitLoad& step_;
};

}  // namespace

void WaitLoad::check(const scene::StepSource& source) const {
  source.require(source.machine && !source.machine->beds.empty(),
                 "wait_load needs a machine with <navvy:bed>");
}

void WaitLoad::check_machine(const scene::Machine& machine) const {
  if (machine.beds.empty())
    throw InputError(Fault{Fault::Severity::kError, machine.file, 0,
                           machine.name + "/navvy:program/wait_load", "",
                           "wait_load needs a machine with a bed", "add <navvy:bed>"});
}

std::unique_ptr<Activity> WaitLoad::activity(OperatorContext& place) const {
  return std::make_unique<WaitingToBeLoaded>(place, *this);
}

}  // namespace navvy::control
