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

using scene::FieldSource;
using scene::kDegree;

// Of a joint: a servo's lag under load is less [m]
constexpr double kShortAngle = radians(3), kShortPath = 0.03;
// [s] before a joint at rest counts as held
constexpr double kSettle = 0.3;
constexpr double kAtRest = 0.02;  // [rad/s|m/s]
// [s] for joints that are slower than their positions
constexpr double kPatience = 5;

// Open loop: it does not look where the joints are while they move, and ends by the clock. Only at
// the end it looks: a joint that is on its way is waited for, one that is held ends the program.
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
    // Between knots k and n; one knot alone is held.
    std::size_t k = 0;
    while (k + 2 < times.size() && times[k + 1] <= t) ++k;
    const std::size_t n = std::min(k + 1, times.size() - 1);
    const double span = times[n] - times[k];
    const double u = span > 0 ? (t - times[k]) / span : 1;
    // One row of positions a knot.
    for (std::size_t i = 0; i < joints_.size(); ++i) {
      const double q = step_.positions[k][i] + u * (step_.positions[n][i] - step_.positions[k][i]);
      const auto joint = static_cast<std::size_t>(joints_[i]);
      out.joints[joint] = vehicle::JointInput{vehicle::JointMode::kPosition, q};
      if (!place_.arm) continue;
      // The next step's move begins where this one has led the arm.
      for (std::size_t axis = 0; axis < 4; ++axis)
        if (joint == place_.joint(axis)) place_.handover.q[axis] = q;
    }
    return phase_time() >= times.back() && arrive(seen, phase_time() - times.back());
  }

  /// Whether the step is over `late` [s] after its last time.
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
      // A joint that lies beside its target and moves may well be driven off by what holds it:
      // patience has an end.
      if (late > kPatience || now.stalled || std::abs(now.velocity) < kAtRest)
        return fall_short(StepState::kBlocked, held_text(joint, now, rest, "its last position"));
    }
    return !on_the_way;
  }

  const Trajectory& step_;
  std::vector<int> joints_;  // indices in Machine::joints
};

/// Whether the machine has the joint, in the unit that it is given in, and gets there.
void check_joint(FieldSource& fields, const scene::Machine* machine, const std::string& name,
                 bool in_degrees, const std::vector<double>& positions) {
  // A machine that could not be read has been told of already.
  if (!machine || machine->links.empty()) return;
  const int index = machine->joint_index(name);
  if (index < 0) {
    std::vector<std::string> names;
    for (const scene::Joint& joint : machine->joints) names.push_back(joint.name);
    fields.error("", name, "no joint of this name in the machine", suggestion(name, names));
    return;
  }
  const scene::Joint& joint = machine->joints[static_cast<std::size_t>(index)];
  // The unit in the element's name must be the joint's: 90 read as metres would be a fault of
  // another kind.
  const bool turns = joint.type == scene::Joint::Type::kRevolute;
  if (!turns && joint.type != scene::Joint::Type::kPrismatic) {
    fields.error("", name, "only revolute and prismatic joints can be moved");
  } else if (turns != in_degrees) {
    fields.error(
        "", name,
        turns ? "a revolute joint needs <positions_deg>" : "a prismatic joint needs <positions_m>");
  } else if (joint.has_limits) {
    const double f = turns ? 1 / kDegree : 1;
    // The first one beyond them is enough to find the slip; rounding of degrees is let pass.
    for (const double position : positions) {
      if (position >= joint.lower - 1e-6 && position <= joint.upper + 1e-6) continue;
      fields.error("", std::to_string(position * f),
                   "must lie within the joint's limits, " + std::to_string(joint.lower * f) +
                       " to " + std::to_string(joint.upper * f));
      break;
    }
  }
}

/// One joint's positions over the times; its name is added to the step.
std::vector<double> read_joint(FieldSource& fields, const scene::Machine* machine,
                               Trajectory& step) {
  std::string name;
  std::vector<double> in_degrees, in_metres;
  fields.attribute("name", name)
      .list("positions_deg", in_degrees, {-36000, 36000}, kDegree)
      .list("positions_m", in_metres, {-1e4, 1e4})
      .finish();
  // Faulty ones, too, so that columns and names stay side by side.
  step.joints.push_back(name);
  // Exactly one of the two.
  const bool turns = fields.has("positions_deg");
  if (turns == fields.has("positions_m")) {
    fields.error("", "", "needs either <positions_deg> or <positions_m>");
    return {};
  }
  // Both lists are SI by now.
  const std::vector<double>& positions = turns ? in_degrees : in_metres;
  if (positions.size() != step.times.size())
    fields.error("", std::to_string(positions.size()) + " positions",
                 "needs one position for each of the " + std::to_string(step.times.size()) +
                     " times of <times_s>");
  check_joint(fields, machine, name, turns, positions);
  return positions;
}

}  // namespace

Trajectory Trajectory::read(const scene::StepSource& source) {
  Trajectory step;
  std::vector<std::vector<double>> columns;
  FieldSource& fields = source.fields;
  fields.list("times_s", step.times, {0, 1e6})
      .required("times_s")
      .each("joint",
            [&](FieldSource& joint) { columns.push_back(read_joint(joint, source.machine, step)); })
      .required("joint")
      .finish();
  // Equal times would be a jump, for which no joint has a servo.
  for (std::size_t i = 1; i < step.times.size(); ++i)
    if (step.times[i] <= step.times[i - 1]) {
      fields.error("times_s", fields.written("times_s"), "times must increase");
      break;
    }
  if (fields.has("times_s") && step.times.empty())
    fields.error("times_s", "", "needs at least one time");
  // The file gives a row a joint, the operator wants a row a time.
  step.positions.assign(step.times.size(), std::vector<double>(columns.size(), 0.0));
  for (std::size_t j = 0; j < columns.size(); ++j)
    for (std::size_t k = 0; k < step.times.size() && k < columns[j].size(); ++k)
      step.positions[k][j] = columns[j][k];
  return step;
}

void Trajectory::check_machine(const scene::Machine& machine) const {
  // Programs built in C++ may be anything: the run relies on what is asked here.
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
