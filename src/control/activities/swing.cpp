// SPDX-License-Identifier: Apache-2.0
#include "control/activities/swing.h"

#include "control/arm_move.h"
#include "control/reach.h"

namespace navvy::control {
namespace {

// One move; patience and warnings are the move's.
class Swinging final : public ActivityWith<ArmMove> {
 public:
  Swinging(Workplace& place, const Swing& step) : ActivityWith(place), step_(step) {}
  const char* phase() const override { return "swing"; }

  void begin(const Observation& seen) override {
    // Boom, stick and bucket stay as commanded: the load stays level.
    m.start(place_, with_arm(step_.angle, place_.arm_angles()), seen, {});
  }

 private:
  bool update(const Observation& seen, double, Command&) override {
    return m.advance(place_, seen, phase_time(), phase());
  }

  const Swing& step_;
};

}  // namespace

Swing Swing::read(const scene::StepSource& source) {
  Swing step;
  source.fields.number("angle_deg", step.angle, {-3600, 3600}, scene::kDegree).required("angle_deg").finish();
  source.require(source.machine && !source.machine->arm.swing.empty(),
                 "swing needs a machine with <navvy:arm>/swing_joint");
  return step;
}

std::unique_ptr<Activity> Swing::activity(Workplace& place) const { return std::make_unique<Swinging>(place, *this); }

void Swing::check_reach(ReachCheck& check) const {
  // An angle is a joint's, not a direction: it is not wound into the limits.
  check.require_swing(Arm(check.machine), "swing", angle, "choose an angle between them");
}

}  // namespace navvy::control
