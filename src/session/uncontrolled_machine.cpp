// SPDX-License-Identifier: Apache-2.0
#include "session/uncontrolled_machine.h"

#include "core/log.h"
#include "session/reports.h"

namespace navvy::session {

void observe_stance(const sim::World& world, const sim::MachineHandle& machine,
                    const std::vector<sim::WheelHandle>& wheels, control::Observation& seen) {
  // The base link represents the machine, as in the coordinates of programs.
  const vehicle::LinkState base = machine.link(0).state();
  seen.X_WB = base.X_WL;
  seen.v_WB = base.v_WL;
  seen.stability = machine.stability();
  seen.tyre_force.setZero();
  seen.wheels_under = 0;
  for (std::size_t w = 0; w < wheels.size(); ++w) {
    const vehicle::WheelState wheel = wheels[w].state();
    seen.tyre_force += wheel.force_W;
    // Only resting soil can bury a wheel; soil in flight cannot.
    const Vec3 top =
        wheel.X_WWheel.translation() + Vec3(0, 0, machine.description().wheels[w].radius);
    if (world.ground().sample(top.x(), top.y()) > top.z())
      seen.wheels_under += 1.0 / double(wheels.size());
  }
}

UncontrolledMachine::UncontrolledMachine(const sim::World& world, int machine)
    : world_(world), machine_(world.machines().at(machine)) {
  for (std::size_t w = 0; w < machine_.description().wheels.size(); ++w)
    wheels_.push_back(machine_.wheel(static_cast<int>(w)));
}

void UncontrolledMachine::look(bool by_inputs) {
  if (fall_) return;
  observe_stance(world_, machine_, wheels_, seen_);
  std::string reason;
  const control::StepState state = watch_.look(seen_, world_.dt(), reason);
  if (!control::fell_short(state)) return;
  const double now = world_.time();
  fall_ = {0, by_inputs ? "inputs" : "idle", state, reason, now, now, seen_.X_WB.translation(), {}};
  // Logged at once: the end of a run may be hours away.
  log_warning(report_line({index(), 0, by_inputs, {*fall_}, {}}, machine_.name()));
}

void UncontrolledMachine::visit(Archive& a) {
  a("watch", watch_);
  a("fall", fall_);
}

}  // namespace navvy::session
