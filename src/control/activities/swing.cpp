// SPDX-License-Identifier: Apache-2.0
#include "control/activities/swing.h"

#include <cmath>

#include "control/arm_move.h"
#include "control/reach.h"

namespace navvy::control {
namespace {

// Tolerance of the swing angle: a load or a slope causes less; more is an obstacle.
constexpr double kShort = radians(3);

// One move, with the move's own patience.
class Swinging final : public ActivityWith<ArmMove> {
 public:
  Swinging(OperatorContext& place, const Swing& step) : ActivityWith(place), step_(step) {}
  const char* phase() const override { return "swing"; }

  void begin(const Observation& seen) override {
    place_.handover.is_out = false;
    // Boom, stick and bucket stay as commanded, so the load stays level.
    Axes to = with_arm(step_.angle, place_.arm_angles());
    for (std::size_t i = 1; step_.tucks && i < to.size(); ++i)
      to[i] = place_.machine.joints[place_.joint(i)].initial;
    m.start(place_, to, seen, {});
  }

 private:
  bool update(const Observation& seen, double, Command&) override {
    if (!m.advance(place_, seen, phase_time(), phase())) return false;
    // A move also ends at rest short of its target: heavy soil can do that to the arm, but not to
    // the swing.
    const double rest = std::abs(step_.angle - seen.joints[place_.joint(0)].position);
    if (rest < kShort) return true;
    return fall_short(StepState::kBlocked,
                      "the swing stopped " + number_text(degrees(rest), "deg") +
                          " short of its angle: something holds the upper structure");
  }

  const Swing& step_;
};

}  // namespace

void Swing::check(const scene::StepSource& source) const {
  source.require(source.machine && !source.machine->arm.swing.empty(),
                 "swing needs a machine with <navvy:arm>/swing_joint");
}

std::unique_ptr<Activity> Swing::activity(OperatorContext& place) const {
  return std::make_unique<Swinging>(place, *this);
}

void Swing::check_reach(ReachCheck& check) const {
  // The angle is a joint position, not a direction: it is not wrapped into the limits.
  check.require_swing(ArmKinematics(check.machine), "swing", angle, "choose an angle between them");
}

}  // namespace navvy::control
