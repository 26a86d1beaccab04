// SPDX-License-Identifier: Apache-2.0
#include "session/order_checks.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "core/edit_distance.h"
#include "core/error.h"
#include "core/log.h"
#include "session/program_check.h"

namespace navvy::session {
namespace {

[[noreturn]] void refuse(const std::string& element, const std::string& value,
                         const std::string& rule, const std::string& remedy) {
  throw InputError(Fault{Fault::Severity::kError, "", 0, element, value, rule, remedy});
}

}  // namespace

int machine_of_order(const scene::Scene& scene, const std::string& name) {
  const int machine = scene.machine_index(name);
  if (machine >= 0) return machine;
  std::vector<std::string> known;
  for (const scene::MachineInWorld& one : scene.machines) known.push_back(one.name);
  refuse("order/machine", name, "no machine of this name in the world", suggestion(name, known));
}

void require_idle(const OperatedMachine& machine) {
  if (!machine.busy()) return;
  const control::ProgramProgress progress = machine.op().progress();
  refuse("order/machine", machine.name(),
         "is busy with step " + std::to_string(progress.done + 1) + " of " +
             std::to_string(progress.steps) + " (" + machine.op().phase() + ")",
         "wait for its end, or order with now to stop it");
}

void require_upright(const std::string& name, const UncontrolledMachine& machine) {
  if (!machine.fall()) return;
  const control::StepState state = machine.fall()->state;
  if (state == control::StepState::kTipped || state == control::StepState::kBuried)
    refuse("order/machine", name, "is " + std::string(control::name_of(state)),
           machine.fall()->reason);
}

scene::Program program_of_order(const sim::World& world, int machine, const std::string& steps,
                                const control::SurfaceView& around,
                                const control::Planners& planners) {
  if (!planners.read_program)
    refuse("order", "", "no program can be ordered here", "hand a reader to the session");
  const scene::Scene& scene = world.description();
  const auto index = static_cast<std::size_t>(machine);
  scene::Program out = planners.read_program(steps, scene.machines[index].machine, scene.ground);
  if (out.steps.empty())
    refuse("order/steps", "", "there are no steps",
           "give at least one, such as <wait><duration_s>1</duration_s></wait>");
  std::vector<Pose> X_WB;
  for (int m = 0; m < world.machines().count(); ++m)
    X_WB.push_back(world.machines().at(m).link(0).pose());
  std::vector<Fault> faults = check_program(scene, index, out, around, X_WB, planners);
  const auto is_error = [](const Fault& one) { return one.severity == Fault::Severity::kError; };
  if (std::any_of(faults.begin(), faults.end(), is_error)) throw InputError(std::move(faults));
  for (const Fault& fault : faults) log_warning(fault.text());
  return out;
}

}  // namespace navvy::session
