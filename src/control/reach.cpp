// SPDX-License-Identifier: Apache-2.0
#include "control/reach.h"

#include <algorithm>
#include <cstdio>
#include <optional>
#include <utility>

#include "control/activity_step.h"

namespace navvy::control {

// Two digits: a centimetre and a hundredth of a degree are finer than any placement of a machine.
std::string number_text(double value, const char* unit) {
  char text[48];
  std::snprintf(text, sizeof text, "%.2f %s", value, unit);
  return text;
}
std::string metres(double value) { return number_text(value, "m"); }
std::string place_text(const Vec2& p) {
  return "(" + number_text(p.x(), "") + ", " + number_text(p.y(), "") + ")";
}

std::string held_text(const scene::Joint& joint, const vehicle::JointState& state, double rest,
                      const std::string& target) {
  const bool turns = joint.type != scene::Joint::Type::kPrismatic;
  return "joint '" + joint.name + "' stopped " +
         (turns ? number_text(degrees(rest), "deg") : metres(rest)) + " short of " + target +
         (state.stalled ? ", at its effort limit" : "") + ": something holds it";
}

ReachCheck::ReachCheck(const scene::Machine& machine_in, const scene::Program& program,
                       const Pose& X_WB_at_start, const SurfaceView& surface_in, std::string file,
                       const std::string& name, const Planners& planners)
    : machine(machine_in),
      surface(surface_in),
      X_WB(X_WB_at_start),
      program_(program),
      file_(std::move(file)),
      name_(name.empty() ? machine_in.name : name) {
  const auto asks = [](const scene::ProgramStep& step) { return step_of(step).needs_planner(); };
  const auto plans = [](const scene::ProgramStep& step) {
    return step_of(step).needs_job_planner();
  };
  if (planners.jobs && std::any_of(program.steps.begin(), program.steps.end(), plans))
    jobs = planners.jobs(machine);
  // A planner looks at the whole site, so it is made only if a step asks for it.
  if (!planners.paths || std::none_of(program.steps.begin(), program.steps.end(), asks)) return;
  std::unique_ptr<PathPlanner> made = planners.paths(machine);
  made->look(surface);
  planner = std::move(made);
}

std::vector<Fault> ReachCheck::run() {
  for (index_ = 0; index_ < program_.steps.size(); ++index_) {
    const ActivityStep& step = step_of(program_.steps[index_]);
    step.check_reach(*this);
    // A drive that misses its target has been reported; the steps after it are checked as if it
    // arrived.
    if (const std::optional<Pose> next = step.station(machine, X_WB, surface)) X_WB = *next;
  }
  return std::exchange(faults_, {});
}

void ReachCheck::fault(const std::string& element, const std::string& value,
                       const std::string& rule, const std::string& remedy) {
  add(Fault::Severity::kError, element, value, rule, remedy);
}

void ReachCheck::note(const std::string& text) {
  notes_.push_back("'" + name_ + "', step " + std::to_string(index_ + 1) + " (" +
                   program_.steps[index_]->element() + "): " + text);
}

void ReachCheck::warn(const std::string& element, const std::string& value, const std::string& rule,
                      const std::string& remedy) {
  add(Fault::Severity::kWarning, element, value, rule, remedy);
}

bool ReachCheck::after_digging() const {
  const auto end = program_.steps.begin() + static_cast<std::ptrdiff_t>(index_);
  // A step with a dump point moves soil, so the ground after it differs from that of the start.
  return std::any_of(program_.steps.begin(), end, [](const scene::ProgramStep& step) {
    return step_of(step).dump_point().has_value();
  });
}

void ReachCheck::add(Fault::Severity severity, const std::string& element, const std::string& value,
                     const std::string& rule, const std::string& remedy) {
  // Programs built in C++ have no lines.
  const int line = index_ < program_.lines.size() ? program_.lines[index_] : 0;
  faults_.push_back({severity, file_, line,
                     name_ + "/navvy:program/step " + std::to_string(index_ + 1) + "/" + element,
                     value, rule, remedy});
}

void ReachCheck::require_swing(const ArmKinematics& arm, const char* element, double swing,
                               const char* remedy) {
  if (arm.swings_to(swing)) return;
  fault(element, number_text(degrees(swing), "deg"),
        "the swing joint turns from " + number_text(degrees(arm.swing_lower()), "deg") + " to " +
            number_text(degrees(arm.swing_upper()), "deg"),
        remedy);
}

std::vector<Fault> check_reach(const scene::Machine& machine, const scene::Program& program,
                               const Pose& X_WB, const SurfaceView& surface,
                               const std::string& file, const std::string& name,
                               const Planners& planners, std::vector<std::string>* notes,
                               std::vector<BodyView> bodies) {
  ReachCheck check(machine, program, X_WB, surface, file, name, planners);
  check.bodies = std::move(bodies);
  std::vector<Fault> faults = check.run();
  if (notes != nullptr) notes->insert(notes->end(), check.notes().begin(), check.notes().end());
  return faults;
}

std::vector<Pose> stations(const scene::Machine& machine, const scene::Program& program,
                           const Pose& X_WB, const SurfaceView& surface) {
  std::vector<Pose> out{X_WB};
  // Steps that do not move the machine are no stations.
  for (const scene::ProgramStep& step : program.steps)
    if (const std::optional<Pose> next = step_of(step).station(machine, out.back(), surface))
      out.push_back(*next);
  return out;
}

}  // namespace navvy::control
