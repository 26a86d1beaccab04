// SPDX-License-Identifier: Apache-2.0
#include "session/session.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <optional>
#include <utility>

#include "core/error.h"
#include "core/file.h"
#include "core/log.h"
#include "core/saved_state.h"
#include "core/sealed.h"
#include "core/stopwatch.h"
#include "device/device.h"
#include "heightfield/design_surface.h"
#include "session/bucket_gauge.h"
#include "session/operated_machine.h"
#include "session/order_checks.h"
#include "session/program_check.h"
#include "session/uncontrolled_machine.h"
#include "sim/snapshot.h"
#include "sim/start_check.h"

namespace navvy::session {
namespace {

/// Active soil delays the end of a run by at most this many settling times.
constexpr double kLongestRest = 6;

}  // namespace

// The world comes first: all other members hold handles into it.
struct Session::State {
  State(scene::Scene description, device::Device& device, control::Planners planners_in,
        const vehicle::PhysicsEngineFactory& make_engine)
      : world(std::move(description), device, make_engine),
        surface(world),
        planners(std::move(planners_in)),
        device_name(device.info().name),
        // The number and order of tools never change.
        tools(world.machines().tools()),
        forbidden(world),
        travel(world) {
    for (int m = 0; m < world.machines().count(); ++m)
      for (const scene::Bucket& bucket : world.machines().at(m).description().buckets)
        buckets.emplace_back(world.machines().at(m), bucket);
    off_site.resize(static_cast<std::size_t>(world.machines().count()));
  }

  // Members are constructed in this order and refer to those above them.
  sim::World world;
  SeenSurface surface;
  const control::Planners planners;
  std::string device_name;
  /// All tools of the world.
  std::vector<sim::ToolHandle> tools;
  /// The buckets of all machines.
  std::vector<BucketGauge> buckets;
  std::optional<heightfield::DesignSurface> design;
  /// Machines with a program in the scene, in its order, then those that got their first one by an
  /// order.
  std::vector<OperatedMachine> operated;
  /// All machines that can tip over; each is watched while no program drives it.
  std::vector<UncontrolledMachine> uncontrolled_machines;
  /// True for each machine whose leaving of the site has been logged.
  std::vector<bool> off_site;
  // Results of the programs.
  std::vector<Cycle> cycles;
  std::vector<BedTip> tips;
  /// Energy account at the end of each cycle. Not part of the state.
  std::vector<std::optional<sim::SoilEnergy>> energy_at_ends;
  /// State of all programs at the start of the step, as operators see them.
  OperatedMachine::Programs programs;
  ForceStatistics force;
  CollisionWatch collisions;
  OverlapWatch overlaps;
  ForbiddenWatch forbidden;
  TravelLog travel;
  /// Simulated time since every program ended [s].
  double idle = 0;
  /// Wall time that operators took [s].
  double control_time = 0;

  /// Returns the machine with its operator; null if it has no program.
  const OperatedMachine* operated_by_program(int machine) const;
  bool has_program(int machine) const;
  void operate(int machine);
  void visit_operated(Archive& a);
  void watch_uncontrolled_machines();
  void watch_border();
  void take_over(int machine);
  bool has_link(int machine, int link) const;
  void note_forces();
  std::vector<MachineOutcome> outcomes() const;
  void visit(Archive& a);
};

/// Evaluates every step, not the rows of telemetry: peaks last milliseconds.
void Session::State::note_forces() {
  for (const sim::ToolHandle& tool : tools) {
    // Rock acts without soil, so it is evaluated before the check for contact.
    force.rock_peak = std::max(force.rock_peak, tool.rock_force().norm());
    const sim::MomentumBalance balance = tool.momentum_balance();
    // Steps without contact do not count for the mean.
    if (!(balance.scale > 0)) continue;
    // The soil in a bed is a load; its weight is no digging force.
    if (!tool.is_bed()) {
      force.peak = std::max(force.peak, tool.smooth_force().norm());
      force.sum += tool.force().norm();
      // Each tool in contact counts its own steps.
      ++force.steps;
    }
    // Rounding errors scale with the magnitudes that cancel in the residual.
    force.residual_max =
        std::max(force.residual_max, balance.residual.cwiseAbs().maxCoeff() / balance.scale);
    if (balance.scale_moment > 0)
      force.residual_max = std::max(
          force.residual_max, balance.residual_moment.cwiseAbs().maxCoeff() / balance.scale_moment);
  }
  for (const BucketGauge& bucket : buckets)
    force.draft_peak = std::max(force.draft_peak, bucket.load().draft);
}

const OperatedMachine* Session::State::operated_by_program(int machine) const {
  for (const OperatedMachine& one : operated)
    if (one.index() == machine) return &one;
  return nullptr;
}

/// Operators watch their own machines, also after the end of their programs.
void Session::State::watch_uncontrolled_machines() {
  for (UncontrolledMachine& one : uncontrolled_machines) {
    const OperatedMachine* program = operated_by_program(one.index());
    if (program == nullptr || program->taken()) one.look(program != nullptr);
  }
}

/// Logs a warning when a machine leaves the site, once per machine. Beyond the border the height of
/// the nearest column continues and carries loads, but there is no soil, so results there are not
/// valid. This is not part of the state, as it decides nothing.
void Session::State::watch_border() {
  const heightfield::Terrain& ground = world.ground();
  for (int m = 0; m < world.machines().count(); ++m) {
    if (off_site[static_cast<std::size_t>(m)]) continue;
    const sim::MachineHandle machine = world.machines().at(m);
    for (std::size_t l = 0; l < machine.description().links.size(); ++l) {
      const sim::LinkHandle link = machine.link(static_cast<int>(l));
      const Vec3 p = link.pose().translation();
      const Vec2i at = ground.column_at(p.x(), p.y());
      if (ground.contains(at.x(), at.y())) continue;
      off_site[static_cast<std::size_t>(m)] = true;
      std::array<char, 96> place{};
      std::snprintf(place.data(), place.size(), "at (%.2f, %.2f) m, %.2f s", p.x(), p.y(),
                    world.time());
      log_warning("'" + machine.name() + "' has left the site with its link '" +
                  machine.description().links[l].name + "', " + place.data() +
                  ": beyond the border the ground continues at the border's height, and nothing "
                  "can dig into it; give the site a larger <size_m> or --size (logged once per "
                  "machine)");
      break;
    }
  }
}

/// Returns the states of the machines that have failed.
std::vector<MachineOutcome> Session::State::outcomes() const {
  std::vector<MachineOutcome> out;
  for (const OperatedMachine& one : operated)
    if (one.op().ended() && !one.op().done()) {
      const control::StepReport& last = one.op().reports().back();
      out.push_back({one.index(), last.state, last.reason});
    }
  for (const UncontrolledMachine& one : uncontrolled_machines)
    if (one.fall()) out.push_back({one.index(), one.fall()->state, one.fall()->reason});
  return out;
}

bool Session::State::has_link(int machine, int link) const {
  const auto& links = world.machines().at(machine).description().links;
  return link >= 0 && static_cast<std::size_t>(link) < links.size();
}

void Session::State::take_over(int machine) {
  for (UncontrolledMachine& one : uncontrolled_machines)
    if (one.index() == machine) one.take();
  for (OperatedMachine& one : operated)
    if (one.index() == machine && one.take())
      log_info("'" + one.name() + "' leaves its program at " + std::to_string(world.time()) +
               " s: inputs drive it");
}

bool Session::State::has_program(int machine) const {
  return !world.description().machines[static_cast<std::size_t>(machine)].program.steps.empty();
}

/// Gives a machine without one an operator.
void Session::State::operate(int machine) {
  operated.emplace_back(world, machine, surface, programs, planners);
}

/// Visits the operators, and those that orders have added.
void Session::State::visit_operated(Archive& a) {
  std::size_t of_scene = 0;
  for (int m = 0; m < world.machines().count(); ++m) of_scene += has_program(m) ? 1 : 0;
  // Programs may have been added to the scene since.
  a.constant("programs", of_scene,
             "the snapshot and the scene have different numbers of programs; use the scene that "
             "the snapshot was made with");
  std::vector<std::int64_t> added;
  for (std::size_t i = of_scene; i < operated.size(); ++i) added.push_back(operated[i].index());
  a.unhashed("states of runs without orders keep their hashes", [&] { a("added", added); });
  if (a.loading()) {
    programs.clear();
    while (operated.size() > of_scene) operated.pop_back();
    for (const std::int64_t m : added) {
      a.require(m >= 0 && m < world.machines().count() &&
                    operated_by_program(static_cast<int>(m)) == nullptr,
                "added", "names no machine without a program");
      operate(static_cast<int>(m));
    }
  }
  for (std::size_t i = 0; i < operated.size(); ++i) a.item(i, [&] { operated[i].visit(a); });
}

/// Visits all state beside the world: reports first, then each operated machine.
void Session::State::visit(Archive& a) {
  // Version 3 added machines taken by inputs; 4 operators; 5 their reports; 6 peaks of draft and
  // uplift; 7 the watch over machines that no program drives; 8 loads of tip and dump, collisions;
  // 9 overlaps, forbidden events, places of machines that no program drives; 10 places of cycles,
  // distances driven; 11 orders.
  a.section("session", 11, [&] {
    a("cycles", cycles);
    a("tips", tips);
    // Reports name machines by their index.
    const auto known = [&](const auto& report) {
      return report.machine >= 0 && report.machine < world.machines().count();
    };
    a.require(std::all_of(cycles.begin(), cycles.end(), known), "cycles",
              "refers to a machine that the scene does not have");
    a.require(std::all_of(tips.begin(), tips.end(), known), "tips",
              "refers to a machine that the scene does not have");
    a("force", force);
    a.unhashed("only reports: a collision changes the states of its machines", [&] {
      a("collisions", collisions);
      a("overlaps", overlaps);
      a("forbidden", forbidden);
    });
    a.unhashed("follows from the states before; states of equal runs keep their hashes",
               [&] { a("travel", travel); });
    const auto both_known = [&](const auto& one) {
      return one.machine >= 0 && one.machine < one.other_machine &&
             one.other_machine < world.machines().count() && has_link(one.machine, one.link) &&
             has_link(one.other_machine, one.other_link);
    };
    a.require(
        std::all_of(collisions.collisions().begin(), collisions.collisions().end(), both_known),
        "collisions", "refers to a machine or link that the scene does not have");
    a.require(std::all_of(overlaps.overlaps().begin(), overlaps.overlaps().end(), both_known),
              "overlaps", "refers to a machine or link that the scene does not have");
    a("idle", idle);
    visit_operated(a);
    for (std::size_t i = 0; i < uncontrolled_machines.size(); ++i)
      a.item(i, [&] { uncontrolled_machines[i].visit(a); });
  });
}

Session::Session(scene::Scene description, device::Device& device,
                 const control::Planners& planners,
                 const vehicle::PhysicsEngineFactory& make_engine)
    : state_(std::make_unique<State>(std::move(description), device, planners, make_engine)) {
  State& s = *state_;
  std::vector<Pose> X_WB;
  // The reach of a machine depends on where it stands on this ground.
  X_WB.reserve(s.world.description().machines.size());
  for (int m = 0; m < s.world.machines().count(); ++m)
    X_WB.push_back(s.world.machines().at(m).link(0).pose());
  // A design that does not fit this site is refused now, not when it is first used.
  s.design = heightfield::make_design(s.world.description(), s.world.ground());
  // Without this check a dig out of reach would only fail minutes into a run.
  std::vector<Fault> faults = check_programs(s.world.description(), s.surface, X_WB, planners);
  // Overlapping bodies would be thrown apart in the first step.
  for (Fault& fault : sim::check_overlaps(s.world.description(), X_WB))
    faults.push_back(std::move(fault));
  for (Fault& fault : sim::check_buried(s.world.description(), X_WB, s.surface.terrain()))
    faults.push_back(std::move(fault));
  for (Fault& fault : sim::check_bodies(s.world.description(), X_WB))
    faults.push_back(std::move(fault));
  const auto is_error = [](const Fault& fault) {
    return fault.severity == Fault::Severity::kError;
  };
  if (std::any_of(faults.begin(), faults.end(), is_error)) throw InputError(std::move(faults));
  for (const Fault& fault : faults) log_warning(fault.text());
  // Programs without errors get their operators. Machines without a program have none.
  for (int m = 0; m < s.world.machines().count(); ++m)
    if (s.world.machines().at(m).stability().free) s.uncontrolled_machines.emplace_back(s.world, m);
  for (int m = 0; m < s.world.machines().count(); ++m)
    if (s.has_program(m)) s.operate(m);
}

Session::~Session() = default;

void Session::step() {
  State& s = *state_;
  {
    // The time of operators is measured apart from that of the world.
    const Lap lap(s.control_time);
    // Operators that wait for others see the programs as they were at the start of the step, so
    // their order does not matter.
    for (const OperatedMachine& one : s.operated) s.programs[one.name()] = one.progress();
    // A machine that inputs or orders drive never ends by itself: its controller ends the run.
    bool busy = false;
    for (OperatedMachine& one : s.operated) {
      busy = busy || one.taken() || one.ordered() || one.busy();
      one.step(s.cycles, s.tips);
    }
    s.watch_uncontrolled_machines();
    s.watch_border();
    // The energy account of a cycle is that of the step in which the cycle ended.
    if (s.energy_at_ends.size() < s.cycles.size())
      s.energy_at_ends.resize(s.cycles.size(), s.world.soil().energy());
    // Only uninterrupted idle time counts; without programs the duration alone ends the run.
    s.idle = busy || s.operated.empty() ? 0 : s.idle + s.world.dt();
  }
  // The world steps with the commands given above. Forces are those of this step.
  s.world.step();
  s.note_forces();
  s.travel.look(s.world);
  const std::vector<sim::MachineContact> contacts = s.world.machines().contacts();
  s.collisions.look(s.world, contacts);
  s.overlaps.look(s.world, contacts);
  s.forbidden.look(s.world, s.collisions,
                   s.forbidden.needs_states() ? s.outcomes() : std::vector<MachineOutcome>(),
                   done());
}

void Session::watch(const std::string& link) { state_->world.watch(link); }

void Session::keep_soil_energy() {
  state_->world.keep_soil_energy();
  state_->energy_at_ends.assign(state_->cycles.size(), std::nullopt);
}

void Session::set(int input, double value) {
  const sim::Inputs& inputs = state_->world.inputs();
  // A value that the world refuses takes no machine from its program, and neither does an input
  // that belongs to no machine.
  inputs.require(input, value);
  state_->take_over(inputs[static_cast<std::size_t>(input)].machine);
  state_->world.inputs().set(input, value);
}
void Session::set(const std::string& input, double value) {
  set(state_->world.inputs().index(input), value);
}

void Session::command(const sim::JointHandle& joint, const vehicle::JointInput& input) {
  // A refused command must not end the program, so it is checked first.
  state_->world.commands().require_valid(joint, input);
  state_->take_over(joint.machine());
  state_->world.commands().set(joint, input);
}
void Session::command(const sim::MachineHandle& machine, const vehicle::DriveInput& input) {
  state_->world.commands().require_valid(machine, input);
  state_->take_over(machine.index());
  state_->world.commands().set(machine, input);
}
void Session::brake(const sim::JointHandle& joint, bool on) {
  state_->world.commands().require_brake(joint);
  state_->take_over(joint.machine());
  state_->world.commands().set_brake(joint, on);
}
void Session::command(const sim::MachineHandle& machine, const vehicle::BaseInput& input) {
  state_->world.commands().require_valid(machine, input);
  state_->take_over(machine.index());
  state_->world.commands().set(machine, input);
}

void Session::order(const std::string& machine, const std::string& steps, bool now) {
  State& s = *state_;
  const int m = machine_of_order(s.world.description(), machine);
  const OperatedMachine* present = s.operated_by_program(m);
  if (present != nullptr && !now) require_idle(*present);
  const auto watched =
      std::find_if(s.uncontrolled_machines.begin(), s.uncontrolled_machines.end(),
                   [&](const UncontrolledMachine& one) { return one.index() == m; });
  if (watched != s.uncontrolled_machines.end()) require_upright(machine, *watched);
  const scene::Program program =
      program_of_order(s.world, m, steps, SurfaceAroundMachine(s.surface, s.world, m), s.planners);
  // The operator is made last, so that a refused order leaves none.
  if (present == nullptr) s.operate(m);
  const auto one = std::find_if(s.operated.begin(), s.operated.end(),
                                [&](const OperatedMachine& each) { return each.index() == m; });
  try {
    one->order(steps, program);
  } catch (...) {
    if (present == nullptr) s.operated.pop_back();
    throw;
  }
  if (watched != s.uncontrolled_machines.end()) watched->hand_over();
  log_info("'" + machine + "' has " + std::to_string(program.steps.size()) +
           (program.steps.size() == 1 ? " step" : " steps") + " ordered at " +
           std::to_string(s.world.time()) + " s");
}

void Session::reshape(const std::function<void(heightfield::Ground&)>& change) {
  state_->world.reshape(change);
  // Checks of the programs have looked at the ground before.
  state_->surface.forget();
}

void Session::add(std::unique_ptr<sim::Sampler> sampler) { state_->world.add(std::move(sampler)); }

bool Session::done() const {
  const scene::Recording& recording = state_->world.description().recording;
  // Moving soil is given time to come to rest, so that the final ground contains it.
  const bool at_rest = state_->world.soil().counts().particles == 0 ||
                       state_->idle >= kLongestRest * recording.settle;
  const bool programs_over = state_->idle > 0 && state_->idle >= recording.settle && at_rest;
  return programs_over || time_is_over() || forbidden().has_value();
}

/// Allows half a step of slack: time is step count x dt and may be rounded below the duration.
bool Session::time_is_over() const {
  return state_->world.time() >=
         state_->world.description().recording.duration - 0.5 * state_->world.dt();
}

const std::optional<ForbiddenEvent>& Session::forbidden() const {
  return state_->forbidden.event();
}

bool Session::complete() const {
  if (forbidden()) return false;
  const auto stands = [](const UncontrolledMachine& one) { return !one.fall(); };
  return std::all_of(state_->uncontrolled_machines.begin(), state_->uncontrolled_machines.end(),
                     stands) &&
         std::all_of(state_->operated.begin(), state_->operated.end(),
                     [](const OperatedMachine& one) { return one.taken() || one.op().done(); });
}

bool Session::fell_short() const {
  const auto fell = [](const UncontrolledMachine& one) { return one.fall().has_value(); };
  return std::any_of(state_->uncontrolled_machines.begin(), state_->uncontrolled_machines.end(),
                     fell) ||
         std::any_of(
             state_->operated.begin(), state_->operated.end(),
             [](const OperatedMachine& one) { return one.op().ended() && !one.op().done(); });
}

const sim::World& Session::world() const { return state_->world; }
const std::string& Session::device_name() const { return state_->device_name; }
const heightfield::DesignSurface* Session::design() const {
  return state_->design ? &*state_->design : nullptr;
}

std::string Session::phase(int machine) const {
  for (const UncontrolledMachine& one : state_->uncontrolled_machines)
    if (one.index() == machine && one.fall()) return control::name_of(one.fall()->state);
  const OperatedMachine* program = state_->operated_by_program(machine);
  if (program == nullptr) return "idle";
  return program->taken() ? "inputs" : program->op().phase();
}

std::vector<ProgramReport> Session::programs() const {
  const double duration = state_->world.description().recording.duration;
  const bool over = time_is_over();
  std::vector<ProgramReport> out;
  for (const OperatedMachine& one : state_->operated) {
    out.push_back(one.report());
    if (!over || !one.busy()) continue;
    control::StepReport& last = out.back().list.back();
    last.state = control::StepState::kOutOfTime;
    std::array<char, 96> text{};
    std::snprintf(text.data(), text.size(), "the run's duration of %g s was over first", duration);
    last.reason = text.data() + (last.reason.empty() ? "" : "; " + last.reason);
  }
  for (const UncontrolledMachine& one : state_->uncontrolled_machines) {
    if (!one.fall()) continue;
    const auto own = std::find_if(out.begin(), out.end(),
                                  [&](const ProgramReport& r) { return r.machine == one.index(); });
    if (own != out.end())
      own->list.push_back(*one.fall());
    else
      out.push_back({one.index(), 0, false, {*one.fall()}, {}});
  }
  std::sort(out.begin(), out.end(),
            [](const auto& a, const auto& b) { return a.machine < b.machine; });
  return out;
}

const std::vector<Cycle>& Session::cycles() const { return state_->cycles; }
const TravelLog& Session::travel() const { return state_->travel; }
const std::vector<BedTip>& Session::tips() const { return state_->tips; }
const CollisionWatch& Session::collisions() const { return state_->collisions; }
const OverlapWatch& Session::overlaps() const { return state_->overlaps; }
const std::vector<std::optional<sim::SoilEnergy>>& Session::energy_at_ends() const {
  return state_->energy_at_ends;
}
const ForceStatistics& Session::force() const { return state_->force; }
double Session::control_time() const { return state_->control_time; }

double Session::energy() const {
  double sum = 0;
  for (int m = 0; m < state_->world.machines().count(); ++m)
    sum += state_->world.machines().at(m).work();
  return sum;
}

/// Operators belong to the state: equal worlds whose programs stand differently have different
/// futures. The world comes first, as its head identifies the scene.
void Session::visit(Archive& a) {
  a("world", state_->world);
  state_->visit(a);
  // The loaded state may have the same step count, so the view of the ground must be dropped.
  if (a.loading()) state_->surface.forget();
}

std::string Session::state_hash() const {
  StateHash sum;
  sum.value(state_->world.hashes().start());
  add_to_hash(sum, *this);
  return sum.hex();
}

std::vector<std::pair<std::string, std::string>> Session::hash_parts() const {
  std::vector<std::pair<std::string, std::string>> out = state_->world.hashes().parts();
  // Operators come last, so that columns of hashes.csv keep their places.
  out.emplace_back("operators", hash_of(*state_).hex());
  return out;
}

namespace {

/// Content of a snapshot file: the start parameters of the run, then its state.
struct SnapshotContent {
  sim::SnapshotStart start;
  Session& session;

  void visit(Archive& a) {
    a("start", start);
    a("session", session);
  }
};

}  // namespace

std::vector<char> Session::snapshot() const {
  // Saving only reads the session.
  const SnapshotContent content{{world().start(), world().description().name},
                                const_cast<Session&>(*this)};
  return seal(saved(content));
}

void Session::restore(const std::vector<char>& bytes, bool anyway) {
  SnapshotContent content{{world().start(), world().description().name, anyway}, *this};
  load_saved(unseal(bytes), content);
}

void Session::save(const std::string& path) const {
  // The content is complete in memory before the file is replaced.
  write_file_atomically(path, snapshot());
}

void Session::load(const std::string& path, bool anyway) {
  const std::vector<char> bytes = read_file(path);
  try {
    restore(bytes, anyway);
  } catch (const InputError& error) {
    Fault fault = error.faults().front();
    fault.file = path;
    throw InputError(fault);
  }
}

}  // namespace navvy::session
