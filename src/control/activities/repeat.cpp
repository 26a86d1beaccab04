// SPDX-License-Identifier: Apache-2.0
#include "control/activities/repeat.h"

#include <algorithm>
#include <vector>

#include "control/activity.h"
#include "control/reach.h"

namespace navvy::control {
namespace {

/// Returns the volume by which the ground is lower than at the start [m3].
double dug_volume(const heightfield::Ground& ground) {
  double out = 0;
  const heightfield::CellRect r = ground.touched_rect();
  for (int iy = r.y0; iy < r.y1; ++iy)
    for (int ix = r.x0; ix < r.x1; ++ix)
      out += std::max(0.0, ground.start_height(ix, iy) - ground.height(ix, iy));
  return out * ground.cell() * ground.cell();
}

// Without state: the operator counts rounds.
class Repeating final : public Activity {
 public:
  Repeating(OperatorContext& place, const Repeat& step) : Activity(place), step_(step) {}
  const char* phase() const override { return "repeat"; }
  void begin(const Observation&) override {}
  std::vector<Measurement> account(const Observation&) const override {
    return {{"rounds", static_cast<double>(rounds())}};
  }

 private:
  /// Returns the number of rounds that are over.
  std::int64_t rounds() const {
    const auto i = static_cast<std::size_t>(place_.step - 1);
    return 1 + (i < place_.rounds.size() ? place_.rounds[i] : 0);
  }
  bool update(const Observation& seen, double, Command&) override {
    if (step_.times && rounds() >= *step_.times)
      remark("all rounds are over");
    else if (step_.has_until && place_.now >= step_.until)
      remark("it is " + number_text(place_.now, "s"));
    else if (step_.has_load && seen.load_of && seen.load_of(step_.into) >= step_.load)
      remark("'" + step_.into + "' is loaded");
    else if (const double dug = step_.has_volume && seen.ground ? dug_volume(*seen.ground) : 0;
             step_.has_volume && dug >= step_.volume)
      remark(number_text(dug, "m3") + " are dug");
    else
      go_back();
    return true;
  }

  const Repeat& step_;
};

}  // namespace

void Repeat::check(const scene::StepSource& source) {
  if (!times && !has_until && !has_volume && !has_load)
    source.error("", "", "repeat needs an end",
                 "add <times>, <until_time_s>, <until_volume_m3>, or <into> and <load_kg>");
  if (has_load && into.empty())
    source.error("load_kg", source.written("load_kg"), "needs the machine that is loaded",
                 "name it in <into>");
  if (!into.empty() && !has_load)
    source.error("into", source.written("into"), "needs the mass at which no round begins",
                 "give it in <load_kg>, or leave out <into>");
}

std::unique_ptr<Activity> Repeat::activity(OperatorContext& place) const {
  return std::make_unique<Repeating>(place, *this);
}

void Repeat::check_reach(ReachCheck& check) const {
  if (static_cast<std::size_t>(steps) > check.steps_before())
    check.fault(
        "repeat/steps", std::to_string(steps),
        "the program has " + std::to_string(check.steps_before()) + " steps before this one",
        "repeat at most so many");
}

}  // namespace navvy::control
