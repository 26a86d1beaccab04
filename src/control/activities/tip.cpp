// SPDX-License-Identifier: Apache-2.0
#include "control/activities/tip.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "control/activity.h"
#include "control/load_change.h"
#include "control/reach.h"
#include "core/error.h"

namespace navvy::control {
namespace {

constexpr double kArrived = radians(1);   // of the bed from its angle
constexpr double kTipPatience = 120;      // [s] for the ram to get there
constexpr double kSlowRate = radians(1);  // [rad/s] slowest bed that is still waited for

struct Memory {
  double standing = 0;  // [s] since the bed has arrived; 0 before
  /// Rotation to perform, at the start [rad].
  double start_rotation = 0;
  LoadChange load;
  bool raises = false;  // the step tips the bed further; otherwise it lowers the bed

  void visit(Archive& a) {
    a("standing", standing);
    a("start_rotation", start_rotation);
    a("load", load);
    a("raises", raises);
  }
};

class Tipping final : public ActivityWith<Memory> {
 public:
  Tipping(OperatorContext& place, const Tip& step)
      : ActivityWith(place),
        step_(step),
        joint_(
            static_cast<std::size_t>(place.machine.joint_index(place.machine.beds.at(0).joint))) {}
  const char* phase() const override { return "tip"; }

  void begin(const Observation& seen) override {
    // The time limit grows with the angle: a ram is slow, and slower under load.
    m.start_rotation = std::abs(step_.angle - seen.joints[joint_].position);
    m.raises = std::abs(step_.angle) > std::abs(seen.joints[joint_].position) + kArrived;
    m.load.start(seen.bed_load);
    tell(CycleEvent::kTipStart);
  }
  std::vector<Measurement> account(const Observation& seen) const override {
    return m.load.account(seen.bed_load, "tipped_kg");
  }

 private:
  bool update(const Observation& seen, double dt, Command& out) override {
    const vehicle::JointState& bed = seen.joints[joint_];
    // Commanded in every step, because an input may have moved the bed in between.
    out.joints[joint_] = vehicle::JointInput{vehicle::JointMode::kPosition, step_.angle};
    const bool late = phase_time() > std::min(kTipPatience, 10 + m.start_rotation / kSlowRate);
    const double rest = std::abs(step_.angle - bed.position);
    // `standing` stays positive once the bed has arrived.
    if (m.standing > 0 || rest < kArrived) m.standing += dt;
    if (m.standing == 0 && late) {
      // Soil that fell out until here counts as tipped.
      tell(CycleEvent::kTipEnd);
      return fall_short(StepState::kStalled,
                        "the bed stopped " + number_text(degrees(rest), "deg") +
                            " short of its angle: its ram does not get it further");
    }
    if (m.standing == 0 || m.standing < step_.hold) return false;
    tell(CycleEvent::kTipEnd);
    // A bed that is lowered keeps what is left in it.
    const std::string shortfall = m.raises ? m.load.shortfall(seen.bed_load, "bed") : "";
    if (shortfall.empty()) return true;
    return fall_short(StepState::kStalled,
                      shortfall + " at " + number_text(degrees(step_.angle), "deg"));
  }

  const Tip& step_;
  const std::size_t joint_;
};

}  // namespace

void Tip::check(const scene::StepSource& source) const {
  const scene::Machine* machine = source.machine;
  source.require(machine && !machine->beds.empty(), "tip needs a machine with <navvy:bed>");
  if (!machine || machine->beds.empty() || !source.has("angle_deg")) return;
  const int index = machine->joint_index(machine->beds[0].joint);
  if (index < 0) return;
  const scene::Joint& joint = machine->joints[static_cast<std::size_t>(index)];
  if (joint.has_limits && (angle < joint.lower - 1e-6 || angle > joint.upper + 1e-6))
    source.error("angle_deg", source.written("angle_deg"),
                 "must be within the limits of the bed's joint, " +
                     std::to_string(joint.lower / scene::kDegree) + " to " +
                     std::to_string(joint.upper / scene::kDegree));
}

void Tip::check_machine(const scene::Machine& machine) const {
  // A bed without a joint of its own is a box on the frame: it carries, but does not tip.
  const std::string joint = machine.beds.empty() ? "" : machine.beds[0].joint;
  if (machine.joint_index(joint) < 0)
    throw InputError(
        Fault{Fault::Severity::kError, machine.file, 0, machine.name + "/navvy:program/tip", joint,
              "tip needs a machine with a bed on a joint of its own", "add <navvy:bed>"});
}

std::unique_ptr<Activity> Tip::activity(OperatorContext& place) const {
  return std::make_unique<Tipping>(place, *this);
}

}  // namespace navvy::control
