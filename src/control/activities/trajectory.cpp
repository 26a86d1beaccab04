// SPDX-License-Identifier: Apache-2.0
#include "control/activities/trajectory.h"

#include <algorithm>
#include <cmath>

#include "control/activity.h"
#include "control/reach.h"
#include "core/edit_distance.h"
#include "core/error.h"

namespace navvy::control {
namespace {

using scene::kDegree;

// Tolerance of a joint's position [m]: a servo's lag under load is smaller.
constexpr double kShortAngle = radians(3), kShortPath = 0.03;
// Time [s] after which a joint at rest counts as held.
constexpr double kSettle = 0.3;
constexpr double kAtRest = 0.02;  // [rad/s|m/s]
// Extra time [s] for joints that are slower than their positions.
constexpr double kPatience = 5;

// Open loop: joints are not observed while they move, and the step ends by the clock. Only at the
// end are they checked: the step waits for a joint that still moves; a joint that is held ends the
// program.
class Following final : public Activity {
 public:
  Following(OperatorContext& place, const Trajectory& step) : Activity(place), step_(step) {
    for (const std::string& name : step.joints) joints_.push_back(place.machine.joint_index(name));
  }
  const char* phase() const override { return "trajectory"; }
  void begin(const Observation&) override {}

 private:
  bool update(const Observation& seen, double, Command& out) override {
    const std::vector<double>& times = step_.times;
    const double t = std::clamp(phase_time(), times.front(), times.back());
    // Between knots k and n; a single knot is held.
    std::size_t k = 0;
    while (k + 2 < times.size() && times[k + 1] <= t) ++k;
    const std::size_t n = std::min(k + 1, times.size() - 1);
    const double span = times[n] - times[k];
    const double u = span > 0 ? (t - times[k]) / span : 1;
    // One row of positions per knot.
    for (std::size_t i = 0; i < joints_.size(); ++i) {
      const double q = step_.positions[k][i] + u * (step_.positions[n][i] - step_.positions[k][i]);
      const auto joint = static_cast<std::size_t>(joints_[i]);
      out.joints[joint] = vehicle::JointInput{vehicle::JointMode::kPosition, q};
      if (!place_.arm) continue;
      // The next step's move starts where this one has led the arm.
      for (std::size_t axis = 0; axis < 4; ++axis)
        if (joint == place_.joint(axis)) place_.handover.q[axis] = q;
    }
    return phase_time() >= times.back() && arrive(seen, phase_time() - times.back());
  }

  /// Returns true when the step is over `late` [s] after its last time.
  bool arrive(const Observation& seen, double late) {
    bool on_the_way = false;
    for (std::size_t i = 0; i < joints_.size(); ++i) {
      const auto j = static_cast<std::size_t>(joints_[i]);
      const scene::Joint& joint = place_.machine.joints[j];
      const vehicle::JointState& now = seen.joints[j];
      const double rest = std::abs(step_.positions.back()[i] - now.position);
      if (rest <= (joint.type == scene::Joint::Type::kPrismatic ? kShortPath : kShortAngle))
        continue;
      on_the_way = true;
      if (late < kSettle) continue;
      // A joint beside its target that moves may be driven off by what holds it, so patience is
      // limited.
      if (late > kPatience || now.stalled || std::abs(now.velocity) < kAtRest)
        return fall_short(StepState::kBlocked, held_text(joint, now, rest, "its last position"));
    }
    return !on_the_way;
  }

  const Trajectory& step_;
  std::vector<int> joints_;  // indices in Machine::joints
};

/// Checks that the machine has the joint of a column, in the unit of its positions, and that they
/// are within its limits.
void check_column(const scene::StepSource& source, const Trajectory::Column& column, int item) {
  const scene::Machine* machine = source.machine;
  const auto fault = [&](const std::string& value, const std::string& rule,
                         const std::string& remedy = "") {
    source.error("joint", value, rule, remedy, item);
  };
  // A machine that could not be read has been reported.
  if (!machine || machine->links.empty()) return;
  const int index = machine->joint_index(column.joint);
  if (index < 0) {
    std::vector<std::string> names;
    for (const scene::Joint& joint : machine->joints) names.push_back(joint.name);
    return fault(column.joint, "no joint of this name in the machine",
                 suggestion(column.joint, names));
  }
  const scene::Joint& joint = machine->joints[static_cast<std::size_t>(index)];
  const bool turns = joint.type == scene::Joint::Type::kRevolute;
  if (!turns && joint.type != scene::Joint::Type::kPrismatic)
    return fault(column.joint, "only revolute and prismatic joints can be moved");
  if (turns != column.turns)
    return fault(column.joint, turns ? "a revolute joint needs <positions_deg>"
                                     : "a prismatic joint needs <positions_m>");
  for (const scene::JointGear& gear : machine->gears)
    if (gear.follower == index)
      return fault(column.joint,
                   "this joint follows joint '" +
                       machine->joints[static_cast<std::size_t>(gear.leader)].name +
                       "' by a fixed ratio",
                   "move that joint");
  if (!joint.has_limits) return;
  const double f = turns ? 1 / kDegree : 1;
  // One position is enough to find the mistake; the slack covers the rounding of degrees.
  for (const double position : column.positions())
    if (position < joint.lower - 1e-6 || position > joint.upper + 1e-6)
      return fault(std::to_string(position * f), "must be within the joint's limits, " +
                                                     std::to_string(joint.lower * f) + " to " +
                                                     std::to_string(joint.upper * f));
}

}  // namespace

void Trajectory::check(const scene::StepSource& source) {
  // Equal times would be a jump, for which no joint has a servo.
  for (std::size_t i = 1; i < times.size(); ++i)
    if (times[i] <= times[i - 1]) {
      source.error("times_s", source.written("times_s"), "times must increase");
      break;
    }
  if (source.has("times_s") && times.empty())
    source.error("times_s", "", "needs at least one time");
  positions.assign(times.size(), std::vector<double>(columns.size(), 0.0));
  for (std::size_t j = 0; j < columns.size(); ++j) {
    const Column& column = columns[j];
    const std::vector<double>& given = column.positions();
    const int item = static_cast<int>(j);
    joints.push_back(column.joint);
    if (column.turns == column.slides) {
      source.error("joint", "", "needs either <positions_deg> or <positions_m>", "", item);
      continue;
    }
    if (given.size() != times.size())
      source.error("joint", std::to_string(given.size()) + " positions",
                   "needs one position for each of the " + std::to_string(times.size()) +
                       " times of <times_s>",
                   "", item);
    check_column(source, column, item);
    // The file has a row per joint, the operator a row per time.
    for (std::size_t k = 0; k < times.size() && k < given.size(); ++k) positions[k][j] = given[k];
  }
}

void Trajectory::check_machine(const scene::Machine& machine) const {
  // Programs built in C++ are unchecked, and the run relies on these conditions.
  const auto fail = [&](const std::string& value, const std::string& rule) {
    throw InputError(Fault{Fault::Severity::kError, machine.file, 0,
                           machine.name + "/navvy:program/trajectory", value, rule,
                           "give every joint one position for each time"});
  };
  if (times.empty()) fail("", "a trajectory needs at least one time");
  if (positions.size() != times.size())
    fail(std::to_string(positions.size()) + " rows", "needs one row of positions for each time");
  for (const auto& row : positions)
    if (row.size() != joints.size())
      fail(std::to_string(row.size()), "a row needs one position for each joint");
  for (const std::string& name : joints)
    if (machine.joint_index(name) < 0) fail(name, "no joint of this name in the machine");
}

std::unique_ptr<Activity> Trajectory::activity(OperatorContext& place) const {
  return std::make_unique<Following>(place, *this);
}

}  // namespace navvy::control
