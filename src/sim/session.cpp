// SPDX-License-Identifier: Apache-2.0
#include "sim/session.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include "core/error.h"
#include "core/file.h"
#include "core/log.h"
#include "core/stopwatch.h"
#include "sim/program_check.h"
#include "sim/soil_surface.h"

namespace navvy::sim {
namespace {

/// Steps between looks at the load of a bucket: it changes slowly and costs a pass over the particles.
constexpr std::uint64_t kPayloadInterval = 12;
/// Soil that is still awake holds the end of the run up to this many settling times.
constexpr double kLongestRest = 6;

}  // namespace

struct Session::State {
  State(scene::World description, device::Device& device) : world(std::move(description), device), surface(world) {
    device_name = device.info().name;
  }

  /// A machine with a program and what its operator sees.
  struct Crew {
    int machine = 0;
    int tool = -1;  ///< index into Coupling::tools of the bucket, -1 without
    int bed = -1;   ///< the same of the bed
    control::Operator op;
    control::Observation seen;
    std::optional<Cycle> open;
    std::optional<BedTip> open_tip;
    bool taken = false;                   ///< by inputs: the program no longer commands
    std::vector<std::uint8_t> commanded;  ///< by joint: the program has
  };

  World world;
  SoilSurface surface;
  std::string device_name;
  std::vector<Crew> crews;
  std::vector<Cycle> cycles;
  std::vector<BedTip> tips;
  std::map<std::string, control::Progress> programs;  ///< as the operators see them: at the start of the step
  ForceStatistics force;
  double idle = 0;  ///< [s] since every program has ended
  double control_time = 0;

  void enlist(int machine);
  void observe(Crew& crew);
  void command(Crew& crew);
  void note_event(Crew& crew);
  void note_tip(Crew& crew);
  void note_progress();
  int tool_of(int machine, const std::string& shell) const;
  void note_forces();
  void hash_operators(StateHash& hash) const;
};

/// Index into Coupling::tools, -1 without.
int Session::State::tool_of(int machine, const std::string& shell) const {
  const scene::Machine& placed = world.description().machines[static_cast<std::size_t>(machine)].machine;
  const auto& tools = world.coupling().tools();
  for (std::size_t t = 0; t < tools.size(); ++t)
    if (tools[t].machine == machine && placed.shells[static_cast<std::size_t>(tools[t].shell)].name == shell)
      return static_cast<int>(t);
  return -1;
}

void Session::State::enlist(int machine) {
  const scene::MachineInWorld& placed = world.description().machines[static_cast<std::size_t>(machine)];
  if (placed.program.steps.empty()) return;
  Crew crew{machine, -1, -1, control::Operator(placed.machine, placed.program), {}, {}, {}, false, {}};
  if (!placed.machine.buckets.empty()) crew.tool = tool_of(machine, placed.machine.buckets[0].shell);
  if (!placed.machine.beds.empty()) crew.bed = tool_of(machine, placed.machine.beds[0].shell);
  crew.seen.joints.resize(placed.machine.joints.size());
  crew.commanded.resize(placed.machine.joints.size());
  crew.seen.ground = &world.ground();
  crew.seen.surface = &surface;
  crew.seen.programs = &programs;
  crews.push_back(std::move(crew));
}

void Session::State::observe(Crew& crew) {
  for (std::size_t j = 0; j < crew.seen.joints.size(); ++j)
    crew.seen.joints[j] = world.joint(crew.machine, static_cast<int>(j));
  const vehicle::LinkState base = world.link(crew.machine, 0);
  crew.seen.X_WB = base.X_WL;
  crew.seen.v_WB = base.v_WL;
  if (crew.tool < 0) return;
  const coupling::ToolLoad& tool = world.coupling().tools()[static_cast<std::size_t>(crew.tool)];
  crew.seen.force = tool.smooth_W.norm();
  if (world.steps() % kPayloadInterval == 0) crew.seen.payload = world.coupling().payload(tool);
}

void Session::State::note_progress() {
  for (const Crew& crew : crews)
    programs[world.description().machines[static_cast<std::size_t>(crew.machine)].name] = crew.op.progress();
}

void Session::State::command(Crew& crew) {
  const control::Command command = crew.op.update(crew.seen, world.time(), world.dt());
  for (std::size_t j = 0; j < command.joints.size(); ++j)
    if (command.joints[j]) {
      world.set_joint(crew.machine, static_cast<int>(j), *command.joints[j]);
      crew.commanded[j] = 1;
    }
  if (command.drive) world.set_drive(crew.machine, *command.drive);
}

void Session::State::note_tip(Crew& crew) {
  if (crew.bed < 0) return;
  const auto payload = [&] {
    return world.coupling().payload(world.coupling().tools()[static_cast<std::size_t>(crew.bed)]);
  };
  const control::CycleEvent event = crew.op.event();
  if (event == control::CycleEvent::kTipStart) crew.open_tip = BedTip{crew.machine, world.time(), 0, payload(), 0};
  if (event != control::CycleEvent::kTipEnd || !crew.open_tip) return;
  crew.open_tip->end = world.time();
  crew.open_tip->payload_end = payload();
  tips.push_back(*crew.open_tip);
  crew.open_tip.reset();
}

void Session::State::note_event(Crew& crew) {
  using control::CycleEvent;
  const CycleEvent event = crew.op.event();
  if (event == CycleEvent::kScoopStart) {
    crew.open = Cycle{};
    crew.open->machine = crew.machine;
    crew.open->start = world.time();
  }
  if (!crew.open) return;
  crew.open->force_peak = std::max(crew.open->force_peak, crew.seen.force);
  const auto payload = [&] {
    return world.coupling().payload(world.coupling().tools()[static_cast<std::size_t>(crew.tool)]);
  };
  if (event == CycleEvent::kLiftOut) {
    crew.open->lift_out = world.time();
    crew.open->payload_lift_out = payload();
  } else if (event == CycleEvent::kDumpStart) {
    crew.open->dump_start = world.time();
    crew.open->payload_dump = payload();
  } else if (event == CycleEvent::kCycleEnd) {
    crew.open->end = world.time();
    cycles.push_back(*crew.open);
    crew.open.reset();
  }
}

void Session::State::note_forces() {
  for (const coupling::ToolLoad& tool : world.coupling().tools()) {
    force.rock_peak = std::max(force.rock_peak, tool.rock_W.norm());
    const soil::ToolImpulse& impulse = tool.impulse;
    if (!(impulse.scale > 0)) continue;
    // What lies in a bed is a load, no digging force.
    if (!world.description().machines[static_cast<std::size_t>(tool.machine)].machine.is_bed(tool.shell)) {
      force.peak = std::max(force.peak, tool.smooth_W.norm());
      force.sum += tool.force_W.norm();
      ++force.steps;
    }
    force.residual_max = std::max(force.residual_max, impulse.residual.cwiseAbs().maxCoeff() / impulse.scale);
    if (impulse.scale_moment > 0)
      force.residual_max =
          std::max(force.residual_max, impulse.residual_moment.cwiseAbs().maxCoeff() / impulse.scale_moment);
  }
}

void Session::State::hash_operators(StateHash& hash) const {
  for (const Crew& crew : crews) {
    crew.op.hash(hash);
    if (crew.taken) hash.value(crew.taken);
  }
}

Session::Session(scene::World description, device::Device& device)
    : state_(std::make_unique<State>(std::move(description), device)) {
  State& s = *state_;
  std::vector<Pose> X_WB;
  X_WB.reserve(s.world.description().machines.size());
  for (std::size_t m = 0; m < s.world.description().machines.size(); ++m) {
    s.enlist(static_cast<int>(m));
    X_WB.push_back(s.world.link(static_cast<int>(m), 0).X_WL);
  }
  std::vector<Fault> faults = check_programs(s.world.description(), s.surface, X_WB);
  const auto is_error = [](const Fault& fault) { return fault.severity == Fault::Severity::kError; };
  if (std::any_of(faults.begin(), faults.end(), is_error)) throw InputError(std::move(faults));
  for (const Fault& fault : faults) log_warning(fault.text());
}

Session::~Session() = default;

void Session::step() {
  State& s = *state_;
  {
    const Lap lap(s.control_time);
    bool busy = false;
    s.note_progress();
    for (State::Crew& crew : s.crews) {
      busy = busy || crew.taken || !crew.op.done();
      if (crew.taken) continue;
      s.observe(crew);
      s.command(crew);
      s.note_event(crew);
      s.note_tip(crew);
    }
    s.idle = busy || s.crews.empty() ? 0 : s.idle + s.world.dt();
  }
  s.world.step();
  s.note_forces();
}

void Session::take_over(const std::string& input) {
  for (State::Crew& crew : state_->crews) {
    const scene::MachineInWorld& placed = state_->world.description().machines[static_cast<std::size_t>(crew.machine)];
    const std::string& name = placed.name;
    if (crew.taken || input.rfind(name + "/", 0) != 0) continue;
    crew.taken = true;
    // What the program had set in motion stops.
    for (std::size_t j = 0; j < crew.commanded.size(); ++j)
      if (crew.commanded[j] != 0)
        state_->world.set_joint(crew.machine, static_cast<int>(j), {vehicle::JointMode::kVelocity, 0});
    if (placed.machine.has_drive)
      state_->world.set_drive(crew.machine, {0, state_->world.drive(crew.machine).steer, true});
    crew.open.reset();
    crew.open_tip.reset();
    log_info("'" + name + "' leaves its program at " + std::to_string(state_->world.time()) + " s: inputs drive it");
  }
}

bool Session::done() const {
  const scene::Recording& recording = state_->world.description().recording;
  // The ground left behind should be the whole of it: soil that still moves is given time to come to rest.
  const bool at_rest = state_->world.soil().stats().particles == 0 || state_->idle >= kLongestRest * recording.settle;
  const bool programs_over = !state_->crews.empty() && state_->idle >= recording.settle && at_rest;
  return programs_over || state_->world.time() >= recording.duration - 0.5 * state_->world.dt();
}

World& Session::world() { return state_->world; }
const World& Session::world() const { return state_->world; }
const std::string& Session::device_name() const { return state_->device_name; }

std::string Session::phase(int machine) const {
  for (const State::Crew& crew : state_->crews)
    if (crew.machine == machine) return crew.taken ? "inputs" : crew.op.phase();
  return "idle";
}

const std::vector<Cycle>& Session::cycles() const { return state_->cycles; }
const std::vector<BedTip>& Session::tips() const { return state_->tips; }
const ForceStatistics& Session::force() const { return state_->force; }
double Session::control_time() const { return state_->control_time; }

double Session::energy() const {
  double sum = 0;
  for (std::size_t m = 0; m < state_->world.description().machines.size(); ++m)
    sum += state_->world.work(static_cast<int>(m));
  return sum;
}

std::string Session::state_hash() const {
  StateHash sum;
  state_->world.hash(sum);
  state_->hash_operators(sum);
  return sum.hex();
}

std::vector<std::pair<std::string, std::string>> Session::hash_parts() const {
  std::vector<std::pair<std::string, std::string>> out = state_->world.hash_parts();
  StateHash operators;
  state_->hash_operators(operators);
  out.emplace_back("operators", operators.hex());
  return out;
}

void Session::save(StateWriter& writer) const {
  static_assert(std::is_trivially_copyable_v<Cycle> && std::is_trivially_copyable_v<BedTip>);
  state_->world.save(writer);
  writer.begin("session", 3);
  writer.vector(state_->cycles);
  writer.vector(state_->tips);
  writer.value(state_->force);
  writer.value(state_->idle);
  writer.value(static_cast<std::uint64_t>(state_->crews.size()));
  for (const State::Crew& crew : state_->crews) {
    writer.value(crew.seen.payload);
    writer.value(static_cast<std::uint8_t>(crew.open.has_value()));
    writer.value(crew.open.value_or(Cycle{}));
    writer.value(static_cast<std::uint8_t>(crew.open_tip.has_value()));
    writer.value(crew.open_tip.value_or(BedTip{}));
    writer.value(static_cast<std::uint8_t>(crew.taken));
    writer.vector(crew.commanded);
  }
  writer.end();
  for (const State::Crew& crew : state_->crews) crew.op.save(writer);
}

void Session::load(StateReader& reader) {
  state_->world.load(reader);
  reader.begin("session", 3);
  state_->cycles = reader.vector<Cycle>();
  state_->tips = reader.vector<BedTip>();
  state_->force = reader.value<ForceStatistics>();
  state_->idle = reader.value<double>();
  if (reader.value<std::uint64_t>() != state_->crews.size())
    throw InputError(Fault{Fault::Severity::kError, "snapshot", 0, "session", "",
                           "the snapshot has another number of programs than the scene",
                           "use the scene it was made with"});
  for (State::Crew& crew : state_->crews) {
    crew.seen.payload = reader.value<double>();
    const bool open = reader.value<std::uint8_t>() != 0;
    const auto cycle = reader.value<Cycle>();
    crew.open = open ? std::optional<Cycle>(cycle) : std::nullopt;
    const bool tipping = reader.value<std::uint8_t>() != 0;
    const auto tip = reader.value<BedTip>();
    crew.open_tip = tipping ? std::optional<BedTip>(tip) : std::nullopt;
    crew.taken = reader.value<std::uint8_t>() != 0;
    std::vector<std::uint8_t> commanded = reader.vector<std::uint8_t>();
    if (commanded.size() != crew.commanded.size())
      throw InputError(Fault{Fault::Severity::kError, "snapshot", 0, "session", "",
                             "the snapshot has a machine with another number of joints than the scene",
                             "use the scene it was made with"});
    crew.commanded = std::move(commanded);
  }
  reader.end();
  for (State::Crew& crew : state_->crews) crew.op.load(reader);
}

void Session::save(const std::string& path) const {
  StateWriter writer;
  save(writer);
  write_file_atomically(path, writer.bytes());
}

void Session::load(const std::string& path) {
  StateReader reader(read_file(path));
  try {
    load(reader);
  } catch (const InputError& error) {
    Fault fault = error.faults().front();
    fault.file = path;
    throw InputError(fault);
  }
}

}  // namespace navvy::sim
