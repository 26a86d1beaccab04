// SPDX-License-Identifier: Apache-2.0
#include "control/activities/unhitch.h"

#include <string>

#include "control/activity.h"

namespace navvy::control {
namespace {

class LettingGo final : public Activity {
 public:
  LettingGo(OperatorContext& place, const Unhitch& step) : Activity(place), step_(step) {}
  const char* phase() const override { return "unhitch"; }
  void begin(const Observation&) override {}

 private:
  bool update(const Observation& seen, double, Command& out) override {
    if (seen.is_hitched && !seen.is_hitched(step_.hitch)) {
      const std::string text = "the hitch '" + step_.hitch + "' was open already";
      place_.warn(text);
      remark(text);
    }
    out.unhitch = step_.hitch;
    return true;
  }

  const Unhitch& step_;
};

}  // namespace

std::unique_ptr<Activity> Unhitch::activity(OperatorContext& place) const {
  return std::make_unique<LettingGo>(place, *this);
}

}  // namespace navvy::control
