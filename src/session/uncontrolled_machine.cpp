// SPDX-License-Identifier: Apache-2.0
#include "session/uncontrolled_machine.h"

#include "control/reach.h"
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

bool is_coupled(const sim::World& world, int machine) {
  const std::vector<scene::Hitch>& hitches = world.description().hitches;
  for (std::size_t h = 0; h < hitches.size(); ++h)
    if ((hitches[h].parent == machine || hitches[h].child == machine) &&
        world.machines().hitch(static_cast<int>(h)).closed)
      return true;
  return false;
}

UncontrolledMachine::UncontrolledMachine(const sim::World& world, int machine)
    : world_(world),
      machine_(world.machines().at(machine)),
      stood_(machine_.link(0).pose().translation()) {
  for (std::size_t w = 0; w < machine_.description().wheels.size(); ++w)
    wheels_.push_back(machine_.wheel(static_cast<int>(w)));
}

void UncontrolledMachine::hand_over() {
  if (fall_ &&
      (fall_->state == control::StepState::kMoved || fall_->state == control::StepState::kOffSite))
    fall_.reset();
}

void UncontrolledMachine::look(bool by_inputs) {
  const bool moved = fall_ && fall_->state == control::StepState::kMoved;
  if (fall_ && !moved) return;
  if (by_inputs) driven_ = true;
  observe_stance(world_, machine_, wheels_, seen_);
  std::string reason;
  control::StepState state = watch_.look(seen_, world_.dt(), reason);
  if (!control::fell_short(state)) state = look_at_place(reason);
  if (!control::fell_short(state) || (moved && state == control::StepState::kMoved)) return;
  const double now = world_.time();
  fall_ = {0, by_inputs ? "inputs" : "idle", state, reason, now, now, seen_.X_WB.translation(), {}};
  // Logged at once: the end of a run may be hours away.
  log_warning(report_line({index(), 0, by_inputs, {*fall_}, {}}, machine_.name()));
}

// A machine that is towed or driven has no place to keep; from its release on it keeps the place it
// was released at.
control::StepState UncontrolledMachine::look_at_place(std::string& reason) {
  const Vec3 p = seen_.X_WB.translation();
  const bool off = control::is_off_site(world_.ground(), p);
  if (off && on_site_) {
    reason = "its base is beyond the border of the site";
    return control::StepState::kOffSite;
  }
  on_site_ = !off;
  if (driven_ || is_coupled(world_, index())) stood_ = p;
  const double moved = (p - stood_).head<2>().norm();
  if (!(moved > control::kMostMoved)) return control::StepState::kRunning;
  reason = "it slid or was pushed " + control::metres(moved) + " while nothing drove it";
  return control::StepState::kMoved;
}

void UncontrolledMachine::visit(Archive& a) {
  a("watch", watch_);
  a("fall", fall_);
  a.unhashed("follows from the states before; states of equal runs keep their hashes", [&] {
    a("stood", stood_);
    a("driven", driven_);
    a("on_site", on_site_);
  });
}

}  // namespace navvy::session
