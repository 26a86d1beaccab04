// SPDX-License-Identifier: Apache-2.0
#include "session/session.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include "control/operator.h"
#include "core/error.h"
#include "core/file.h"
#include "core/log.h"
#include "core/saved_state.h"
#include "core/stopwatch.h"
#include "device/device.h"
#include "session/program_check.h"
#include "sim/terrain_view.h"

namespace navvy::session {
namespace {

/// Steps between looks at the load of a bucket: it changes slowly and costs a pass over the particles.
constexpr std::uint64_t kPayloadInterval = 12;
/// Soil that is still awake holds the end of the run up to this many settling times.
constexpr double kLongestRest = 6;

/// What an operator sees from its cab: columns and the loose soil on them. Takes one view in every step in which it is
/// asked, so it has no memory that a snapshot would need; one look costs a pass over the particles.
class SeenSurface final : public control::SurfaceView {
 public:
  explicit SeenSurface(const sim::World& world) : world_(world) {}
  const heightfield::Terrain& terrain() const override {
    if (!view_ || seen_step_ != world_.steps()) {
      view_ = sim::terrain_view(world_, heightfield::SurfaceKind::kWithLooseSoil);
      seen_step_ = world_.steps();
    }
    return *view_;
  }
  /// The next question takes a new view.
  void forget() { view_.reset(); }

 private:
  const sim::World& world_;
  mutable std::optional<heightfield::TerrainView> view_;
  mutable std::uint64_t seen_step_ = 0;
};

}  // namespace

// The world first: everything else looks through handles into it.
struct Session::State {
  State(scene::Scene description, device::Device& device)
      : world(std::move(description), device),
        surface(world),
        device_name(device.info().name),
        // Tools never change in number or order.
        tools(world.tools()) {}

  /// A machine with a program: its operator, what that sees, and the handles to look through.
  struct OperatedMachine {
    OperatedMachine(const sim::MachineHandle& handle, const scene::MachineInWorld& placed);

    sim::MachineHandle machine;
    sim::LinkHandle base;
    std::vector<sim::JointHandle> joints;
    std::optional<sim::ToolHandle> bucket, bed;
    // The operator's own memory is in it; what it saw last is beside it.
    control::Operator op;
    control::Observation seen;
    // Begun and not yet ended.
    std::optional<Cycle> open;
    std::optional<BedTip> open_tip;
    bool taken = false;                   ///< by inputs: the program no longer commands
    std::vector<std::uint8_t> commanded;  ///< by joint: the program has

    void visit(Archive& a);
  };

  // World, surface and handles are built in this order and refer to what stands above.
  sim::World world;
  SeenSurface surface;
  std::string device_name;
  std::vector<sim::ToolHandle> tools;  ///< all of the world
  // In the order of the scene; machines without a program are not in it.
  std::vector<OperatedMachine> operated;
  // What programs came to.
  std::vector<Cycle> cycles;
  std::vector<BedTip> tips;
  std::map<std::string, control::ProgramProgress> programs;  ///< as the operators see them: at the start of the step
  ForceStatistics force;
  double idle = 0;  ///< [s] since every program has ended
  double control_time = 0;

  void enlist(int machine);
  void take_over(int machine);
  void observe(OperatedMachine& one);
  void command(OperatedMachine& one);
  void note_cycle(OperatedMachine& one);
  void note_tip(OperatedMachine& one);
  void note_progress();
  void note_forces();
  void visit(Archive& a);
};

Session::State::OperatedMachine::OperatedMachine(const sim::MachineHandle& handle, const scene::MachineInWorld& placed)
    : machine(handle), base(handle.link(0)), op(placed.machine, placed.program) {
  // A machine digs with its first bucket and tips its first bed; the others are passive.
  if (!placed.machine.buckets.empty()) bucket = handle.tool(placed.machine.buckets[0].shell);
  if (!placed.machine.beds.empty()) bed = handle.tool(placed.machine.beds[0].shell);
  for (std::size_t j = 0; j < placed.machine.joints.size(); ++j) joints.push_back(handle.joint(static_cast<int>(j)));
  // Sized once: observing takes no memory.
  seen.joints.resize(joints.size());
  commanded.resize(joints.size());
}

/// Machines without a program have no operator; inputs drive them.
void Session::State::enlist(int machine) {
  const scene::MachineInWorld& placed = world.description().machines[static_cast<std::size_t>(machine)];
  if (placed.program.steps.empty()) return;
  OperatedMachine one(world.machine(machine), placed);
  // What operators see beside their own machine is shared and belongs to the session.
  one.seen.ground = &world.ground();
  one.seen.surface = &surface;
  one.seen.programs = &programs;
  operated.push_back(std::move(one));
}

/// What a cab shows: gauges of the joints, where it stands, how hard the bucket is pushed and how full it is.
void Session::State::observe(OperatedMachine& one) {
  for (std::size_t j = 0; j < one.joints.size(); ++j) one.seen.joints[j] = one.joints[j].state();
  // The base link stands for the machine, as in programs' coordinates.
  const vehicle::LinkState base = one.base.state();
  one.seen.X_WB = base.X_WL;
  one.seen.v_WB = base.v_WL;
  // A machine without a bucket carries no load that a gauge would show.
  if (!one.bucket) return;
  // Low-passed: an operator reacts to the push, not to single particles.
  one.seen.force = one.bucket->smooth_force().norm();
  if (world.steps() % kPayloadInterval == 0) one.seen.payload = one.bucket->payload();
}

/// By name, as programs call each other.
void Session::State::note_progress() {
  for (const OperatedMachine& one : operated) programs[one.machine.name()] = one.op.progress();
}

/// A joint without a new command keeps its last one: operators speak only when something changes.
void Session::State::command(OperatedMachine& one) {
  // Time and step go in: operators have no clock of their own.
  const control::Command command = one.op.update(one.seen, world.time(), world.dt());
  for (std::size_t j = 0; j < command.joints.size(); ++j)
    if (command.joints[j]) {
      // Remembered, so that a take-over stops just these.
      world.command(one.joints[j], *command.joints[j]);
      one.commanded[j] = 1;
    }
  if (command.drive) world.command(one.machine, *command.drive);
}

/// Masses are taken at the moment of the event: what falls off on the way does not count as tipped.
void Session::State::note_tip(OperatedMachine& one) {
  if (!one.bed) return;
  // Events are told once, in the step in which they happen.
  const control::CycleEvent event = one.op.event();
  if (event == control::CycleEvent::kTipStart)
    one.open_tip = BedTip{one.machine.index(), world.time(), 0, one.bed->payload(), 0};
  if (event != control::CycleEvent::kTipEnd || !one.open_tip) return;
  one.open_tip->end = world.time();
  one.open_tip->payload_end = one.bed->payload();
  tips.push_back(*one.open_tip);
  one.open_tip.reset();
}

/// A cycle is open from the first touch to the end of the dump; one that never ends is not counted.
void Session::State::note_cycle(OperatedMachine& one) {
  using control::CycleEvent;
  // The same for digs.
  const CycleEvent event = one.op.event();
  if (event == CycleEvent::kScoopStart) {
    one.open = Cycle{};
    one.open->machine = one.machine.index();
    // Masses and forces of this cycle are filled in as it goes.
    one.open->start = world.time();
  }
  // Without a bucket nothing is ever opened: only digs tell of scoops.
  if (!one.open || !one.bucket) return;
  // The peak of the low-passed force is what a cylinder would feel.
  one.open->force_peak = std::max(one.open->force_peak, one.seen.force);
  if (event == CycleEvent::kLiftOut) {
    one.open->lift_out = world.time();
    one.open->payload_lift_out = one.bucket->payload();
  } else if (event == CycleEvent::kDumpStart) {
    one.open->dump_start = world.time();
    one.open->payload_dump = one.bucket->payload();
  } else if (event == CycleEvent::kCycleEnd) {
    one.open->end = world.time();
    cycles.push_back(*one.open);
    one.open.reset();
  }
}

/// Over every step and not at telemetry's rate: peaks last milliseconds.
void Session::State::note_forces() {
  for (const sim::ToolHandle& tool : tools) {
    // Rock acts without soil, so before the question of contact.
    force.rock_peak = std::max(force.rock_peak, tool.rock_force().norm());
    const sim::MomentumBalance balance = tool.momentum_balance();
    // No contact in this step: no sample of the mean, either.
    if (!(balance.scale > 0)) continue;
    // What lies in a bed is a load, no digging force.
    if (!tool.is_bed()) {
      force.peak = std::max(force.peak, tool.smooth_force().norm());
      force.sum += tool.force().norm();
      // Each tool in contact counts a step of its own.
      ++force.steps;
    }
    // Relative to the magnitudes that cancel in it: that is what rounding scales with.
    force.residual_max = std::max(force.residual_max, balance.residual.cwiseAbs().maxCoeff() / balance.scale);
    if (balance.scale_moment > 0)
      force.residual_max =
          std::max(force.residual_max, balance.residual_moment.cwiseAbs().maxCoeff() / balance.scale_moment);
  }
}

void Session::State::take_over(int machine) {
  for (OperatedMachine& one : operated) {
    if (one.taken || one.machine.index() != machine) continue;
    // For good: a program that came back would find its machine somewhere else.
    one.taken = true;
    // What the program had set in motion stops; joints that it never touched keep the command they have.
    for (std::size_t j = 0; j < one.commanded.size(); ++j)
      if (one.commanded[j] != 0) world.command(one.joints[j], {vehicle::JointMode::kVelocity, 0});
    if (one.machine.description().has_drive) world.command(one.machine, {0, one.machine.drive().steer, true});
    // A cycle cut short has no end to report.
    one.open.reset();
    one.open_tip.reset();
    log_info("'" + one.machine.name() + "' leaves its program at " + std::to_string(world.time()) +
             " s: inputs drive it");
  }
}

void Session::State::OperatedMachine::visit(Archive& a) {
  // Of what the operator saw only the load is older than a step.
  a("payload", seen.payload);
  a("open_cycle", open);
  a("open_tip", open_tip);
  // The operator's state stands still once its machine is taken, but that may go anywhere.
  a("taken", taken);
  // As many as the scene's machine has joints.
  a.fixed("commanded", commanded);
  a("operator", op);
}

/// What is not the world's: reports first, then each operated machine.
void Session::State::visit(Archive& a) {
  // Version 3: machines taken by inputs; 4: operators within, one visit drives hash, save and load.
  a.section("session", 4, [&] {
    a("cycles", cycles);
    a("tips", tips);
    // Reports name machines by their index.
    const auto known = [&](const auto& report) {
      return report.machine >= 0 && report.machine < world.machine_count();
    };
    a.require(std::all_of(cycles.begin(), cycles.end(), known), "cycles", "names a machine that the scene has not");
    a.require(std::all_of(tips.begin(), tips.end(), known), "tips", "names a machine that the scene has not");
    a("force", force);
    a("idle", idle);
    // Programs may have been added to the scene since.
    a.constant("programs", operated.size(),
               "the snapshot has another number of programs than the scene; use the scene it was made with");
    for (std::size_t i = 0; i < operated.size(); ++i) a.item(i, [&] { operated[i].visit(a); });
  });
}

Session::Session(scene::Scene description, device::Device& device)
    : state_(std::make_unique<State>(std::move(description), device)) {
  State& s = *state_;
  std::vector<Pose> X_WB;
  // Reach depends on where the machines stand on this very ground.
  X_WB.reserve(s.world.description().machines.size());
  for (int m = 0; m < s.world.machine_count(); ++m) {
    s.enlist(m);
    X_WB.push_back(s.world.machine(m).link(0).pose());
  }
  // Told before anything moves: a dig out of reach would otherwise show minutes into a run.
  std::vector<Fault> faults = check_programs(s.world.description(), s.surface, X_WB);
  const auto is_error = [](const Fault& fault) { return fault.severity == Fault::Severity::kError; };
  if (std::any_of(faults.begin(), faults.end(), is_error)) throw InputError(std::move(faults));
  for (const Fault& fault : faults) log_warning(fault.text());
}

Session::~Session() = default;

void Session::step() {
  State& s = *state_;
  {
    // Deciding is timed apart from simulating.
    const Lap lap(s.control_time);
    // A taken machine never ends by itself: whoever drives it ends the run.
    bool busy = false;
    // Before any operator moves on: what they wait for is as it stood when the step began, whatever their order.
    s.note_progress();
    for (State::OperatedMachine& one : s.operated) {
      busy = busy || one.taken || !one.op.done();
      if (one.taken) continue;
      s.observe(one);
      s.command(one);
      s.note_cycle(one);
      s.note_tip(one);
    }
    // Only an unbroken idle time counts; without programs the duration alone ends the run.
    s.idle = busy || s.operated.empty() ? 0 : s.idle + s.world.dt();
  }
  // The world steps with all commands of this instant; forces are of the step just taken.
  s.world.step();
  s.note_forces();
}

void Session::set(int input, double value) {
  // Channels know their machine; one of none takes nobody from a program.
  const std::vector<sim::Channel>& inputs = state_->world.inputs();
  // A value that the world refuses takes no machine from its program.
  if (input >= 0 && static_cast<std::size_t>(input) < inputs.size() && std::isfinite(value))
    state_->take_over(inputs[static_cast<std::size_t>(input)].machine);
  state_->world.set(input, value);
}
void Session::set(const std::string& input, double value) { set(state_->world.input(input), value); }

// Handles say which machine they are of.
void Session::command(const sim::JointHandle& joint, const vehicle::JointInput& input) {
  // First what may refuse: a refused command must not end the program.
  state_->world.require_valid(joint, input);
  state_->take_over(joint.machine());
  state_->world.command(joint, input);
}
void Session::command(const sim::MachineHandle& machine, const vehicle::DriveInput& input) {
  state_->world.require_valid(machine, input);
  state_->take_over(machine.index());
  state_->world.command(machine, input);
}

void Session::add(std::unique_ptr<sim::Sampler> sampler) { state_->world.add(std::move(sampler)); }

/// Half a step of slack: time is a product and may fall a hair short of the duration.
bool Session::done() const {
  const scene::Recording& recording = state_->world.description().recording;
  // The ground left behind should be the whole of it: soil that still moves is given time to come to rest.
  const bool at_rest = state_->world.soil_counts().particles == 0 || state_->idle >= kLongestRest * recording.settle;
  const bool programs_over = !state_->operated.empty() && state_->idle >= recording.settle && at_rest;
  return programs_over || state_->world.time() >= recording.duration - 0.5 * state_->world.dt();
}

const sim::World& Session::world() const { return state_->world; }
const std::string& Session::device_name() const { return state_->device_name; }

/// In words, for progress lines and telemetry.
std::string Session::phase(int machine) const {
  for (const State::OperatedMachine& one : state_->operated)
    if (one.machine.index() == machine) return one.taken ? "inputs" : one.op.phase();
  return "idle";
}

const std::vector<Cycle>& Session::cycles() const { return state_->cycles; }
const std::vector<BedTip>& Session::tips() const { return state_->tips; }
const ForceStatistics& Session::force() const { return state_->force; }
double Session::control_time() const { return state_->control_time; }

/// Summed when asked: it is read at checkpoints only.
double Session::energy() const {
  double sum = 0;
  for (int m = 0; m < state_->world.machine_count(); ++m) sum += state_->world.machine(m).work();
  return sum;
}

void Cycle::visit(Archive& a) {
  a("machine", machine);
  a("start", start);
  a("lift_out", lift_out);
  a("dump_start", dump_start);
  a("end", end);
  a("payload_lift_out", payload_lift_out);
  a("payload_dump", payload_dump);
  a("force_peak", force_peak);
}

void BedTip::visit(Archive& a) {
  a("machine", machine);
  a("start", start);
  a("end", end);
  a("payload_start", payload_start);
  a("payload_end", payload_end);
}

void ForceStatistics::visit(Archive& a) {
  a("peak", peak);
  a("sum", sum);
  a("steps", steps);
  a("rock_peak", rock_peak);
  a("residual_max", residual_max);
}

/// Operators belong to the state: two runs in equal worlds part where their programs stand differently. The world comes
/// first, whose head tells the scene.
void Session::visit(Archive& a) {
  a("world", state_->world);
  state_->visit(a);
  // Another state may have the same number of steps: what the operators saw is not what is there.
  if (a.loading()) state_->surface.forget();
}

std::string Session::state_hash() const { return hash_of(*this).hex(); }

std::vector<std::pair<std::string, std::string>> Session::hash_parts() const {
  std::vector<std::pair<std::string, std::string>> out = state_->world.hash_parts();
  // The last column, after all parts of the world.
  out.emplace_back("operators", hash_of(*state_).hex());
  return out;
}

void Session::save(const std::string& path) const {
  // In memory first: a disk that fills up leaves the old file.
  write_file_atomically(path, saved(*this));
}

// Sections name themselves in messages; the file's name is added here.
void Session::load(const std::string& path) {
  std::vector<char> bytes = read_file(path);
  try {
    load_saved(std::move(bytes), *this);
  } catch (const InputError& error) {
    Fault fault = error.faults().front();
    fault.file = path;
    throw InputError(fault);
  }
}

}  // namespace navvy::session
