// SPDX-License-Identifier: Apache-2.0
#include "sim/world.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/error.h"
#include "core/hash.h"
#include "core/saved_state.h"
#include "sim/names.h"
#include "sim/snapshot.h"
#include "sim/world_channels.h"
#include "sim/world_parts.h"

namespace navvy::sim {
namespace {

constexpr double kHighestRate = 1e5;  // of a controller, as scenes may say [1/s]
constexpr double kRounding = 1e-8;    // of a step that is the quotient of two times

// Commands come from clients, also over a line of text: what an engine cannot use stops here.
void require_machine(int machine, int count) {
  if (machine >= 0 && machine < count) return;
  throw InputError(Fault{Fault::Severity::kError, "", 0, "command", std::to_string(machine),
                         "the handle is of no machine of this world",
                         "take handles from the same world"});
}
void require_finite(const std::string& what, double value) {
  if (std::isfinite(value)) return;
  throw InputError(
      Fault{Fault::Severity::kError, "", 0, what, std::to_string(value), "must be finite", ""});
}

}  // namespace

/// The parts are whole before the first channel is made: channels hold handles into them.
World::World(scene::Scene description, device::Device& device)
    : parts_(std::make_unique<WorldParts>(std::move(description), device)) {
  add_channels(*this, parts_->inputs, parts_->outputs);
}

// Here, where the parts are a complete type.
World::~World() = default;

WorldParts& parts(World& world) { return *world.parts_; }
const WorldParts& parts(const World& world) { return *world.parts_; }

// Plain answers from the parts.
const scene::Scene& World::description() const { return parts_->description; }
double World::dt() const { return parts_->dt; }
double World::longest_step() const { return parts_->longest_step; }
std::uint64_t World::steps() const { return parts_->steps; }
double World::time() const { return parts_->time(); }

/// Samplers come last, so that all of them see the same instant; none of them changes what another
/// one sees.
void World::step() {
  parts_->coupling.step(parts_->dt);
  parts_->advance_encoders();
  ++parts_->steps;
  for (const auto& slot : parts_->samplers)
    if (slot->due(steps(), dt())) slot->sample(*this, time());
}

// Look-ups go through a map once; clients keep the index.
const std::vector<Channel>& World::inputs() const { return parts_->inputs.channels(); }
const std::vector<Channel>& World::outputs() const { return parts_->outputs.channels(); }

namespace {

const auto kName = [](const auto& entry) -> const std::string& { return entry.name; };

/// The map answers names that exist; only for the others is the list searched for the nearest one.
/// `found` when it is an index. @throws InputError that names the nearest channel otherwise.
int require_channel(const std::string& kind, int found, const std::vector<Channel>& channels,
                    const std::string& name) {
  return found >= 0 ? found : index_of(kind, channels, name, kName);
}

}  // namespace

/// Two lists of names: an input and an output may share one, as a joint's position does.
int World::input(const std::string& name) const {
  return require_channel("input", parts_->inputs.find(name), inputs(), name);
}
int World::output(const std::string& name) const {
  return require_channel("output", parts_->outputs.find(name), outputs(), name);
}

void World::set(int input, double value) {
  // Bounds first: the name in the message below is read from the list.
  require_index("input", input, inputs().size());
  // A NaN would go through a servo into every body and only show steps later, without a name.
  if (!std::isfinite(value))
    throw InputError(Fault{Fault::Severity::kError, "", 0,
                           inputs()[static_cast<std::size_t>(input)].name, std::to_string(value),
                           "an input must be a finite number", "send a number"});
  parts_->inputs.function(input)(value);
}

/// One call through a function that holds the handle.
double World::get(int output) const {
  require_index("output", output, outputs().size());
  return parts_->outputs.function(output)();
}

/// Names of parts hold "::" and no slash, so the first one ends the machine's.
void World::watch(const std::string& link) {
  const std::size_t slash = link.find('/');
  if (slash == std::string::npos)
    throw InputError(Fault{Fault::Severity::kError, "", 0, "watch", link,
                           "must name a machine and a link of it", "e.g. excavator/boom"});
  const MachineHandle of = machine(link.substr(0, slash));
  add_link(of.link(link.substr(slash + 1)), of.name(), parts_->outputs);
}

/// Read only: arrays are filled through a sampler's publisher, which stamps them.
const ArrayOutputs& World::arrays() const { return parts_->arrays; }

void World::add(std::unique_ptr<Sampler> sampler) {
  // A slot at an address of its own: outputs keep pointers to its numbers.
  parts_->samplers.push_back(
      std::make_unique<SamplerSlot>(std::move(sampler), parts_->outputs, parts_->arrays));
  // Readers find a value from the start on, as recorders have their first row.
  parts_->samplers.back()->sample(*this, time());
}

int World::machine_count() const { return static_cast<int>(description().machines.size()); }
MachineHandle World::machine(const std::string& name) const {
  return machine(index_of("machine", description().machines, name, kName));
}
/// A handle is the world's parts and an index; who asks with a wrong one learns it here and not
/// while reading.
MachineHandle World::machine(int index) const {
  require_index("machine", index, description().machines.size());
  // Only the world makes handles, so none is ever without parts.
  MachineHandle out;
  out.parts_ = parts_.get();
  out.machine_ = index;
  return out;
}

/// In the exchange's own order, which is machine by machine and shell by shell.
std::vector<ToolHandle> World::tools() const {
  std::vector<ToolHandle> out(parts_->coupling.tools().size());
  for (std::size_t t = 0; t < out.size(); ++t) {
    out[t].parts_ = parts_.get();
    out[t].tool_ = static_cast<int>(t);
  }
  return out;
}

/// Both engines count machines on their own: the exchange knows which engine has the machine, and
/// its index there.
void World::require_valid(const JointHandle& joint, const vehicle::JointInput& input) const {
  require_machine(joint.machine(), machine_count());
  const auto& joints =
      parts_->description.machines[static_cast<std::size_t>(joint.machine())].machine.joints;
  if (joint.index() < 0 || joint.index() >= static_cast<int>(joints.size()))
    throw InputError(Fault{Fault::Severity::kError, "", 0, "command", std::to_string(joint.index()),
                           "the handle is of no joint of this machine",
                           "take handles from the same world"});
  require_finite("command of joint '" + joints[static_cast<std::size_t>(joint.index())].name + "'",
                 input.target);
}
void World::require_valid(const MachineHandle& machine, const vehicle::DriveInput& input) const {
  require_machine(machine.index(), machine_count());
  require_finite("speed of the drive", input.speed);
  require_finite("steering of the drive", input.steer);
  const scene::CombustionEngine* engine = scene::drive_engine(machine.description().drive);
  const int gears = engine == nullptr ? 0 : static_cast<int>(engine->gears.size());
  if (input.gear < 0 || input.gear > gears)
    throw InputError(Fault{
        Fault::Severity::kError, "", 0, "gear of " + machine.name(), std::to_string(input.gear),
        gears == 0 ? "its drive has no gears" : "its gears are 1 to " + std::to_string(gears),
        "give one of them, or 0: it chooses"});
}

/// Angles may count on beyond a turn; a place must be one that a site can have.
void World::require_valid(const MachineHandle& machine, const vehicle::BaseInput& input) const {
  require_machine(machine.index(), machine_count());
  for (int i = 0; i < 3; ++i) {
    require_finite("place of the base", input.p_W[i]);
    require_finite("angle of the base", input.angles[i]);
    if (std::abs(input.p_W[i]) > kFarthest)
      throw InputError(
          Fault{Fault::Severity::kError, "", 0, "place of the base", std::to_string(input.p_W[i]),
                "no site lies farther than 1000 km from the origin", "give metres in the world"});
  }
  if (!(input.duration >= 0) || !std::isfinite(input.duration))
    throw InputError(Fault{Fault::Severity::kError, "", 0, "duration of the base's way",
                           std::to_string(input.duration), "must be 0 or more seconds", ""});
  const scene::Machine& built = machine.description();
  if (!built.kinematic || built.fixed_base)
    throw InputError(
        Fault{Fault::Severity::kError, "", 0, "command", machine.name(),
              built.kinematic ? "its base is held in place" : "forces move this machine",
              "set <navvy:engine>kinematic</navvy:engine>, and leave its base free"});
}

void World::command(const MachineHandle& machine, const vehicle::BaseInput& input) {
  require_valid(machine, input);
  const int m = machine.index();
  parts_->coupling.engine(m).set_base(parts_->coupling.index(m), input);
}
void World::command(const JointHandle& joint, const vehicle::JointInput& input) {
  require_valid(joint, input);
  const int m = joint.machine();
  parts_->coupling.engine(m).set_joint(parts_->coupling.index(m), joint.index(), input);
}
void World::require_brake(const JointHandle& joint) const {
  require_valid(joint, vehicle::JointInput{});
  const scene::Machine& machine =
      parts_->description.machines[static_cast<std::size_t>(joint.machine())].machine;
  if (!(machine.joints[static_cast<std::size_t>(joint.index())].brake > 0))
    throw InputError(Fault{Fault::Severity::kError, "", 0, "brake", joint.name(),
                           "this joint has no brake",
                           "give it <navvy:brake> in the machine's file"});
}
void World::brake(const JointHandle& joint, bool on) {
  require_brake(joint);
  const int m = joint.machine();
  parts_->coupling.engine(m).set_brake(parts_->coupling.index(m), joint.index(), on);
}
void World::couple(int hitch, bool closed) {
  if (hitch < 0 || hitch >= static_cast<int>(parts_->description.hitches.size()))
    throw InputError(Fault{Fault::Severity::kError, "", 0, "hitch", std::to_string(hitch),
                           "the scene has no such hitch", "add <navvy:hitch> to the scene"});
  parts_->dynamic->set_hitch(hitch, closed);
}
vehicle::HitchState World::hitch(int hitch) const { return parts_->dynamic->hitch(hitch); }
/// The drive of a machine without one takes no notice.
void World::command(const MachineHandle& machine, const vehicle::DriveInput& input) {
  require_valid(machine, input);
  const int m = machine.index();
  parts_->coupling.engine(m).set_drive(parts_->coupling.index(m), input);
}

/// The columns; loose soil lies beside them in loose_soil.
const heightfield::Ground& World::ground() const { return parts_->ground; }

// What follows copies figures of the solver into sim's own types, so that no client includes a
// header of the soil.
SoilCounts World::soil_counts() const {
  const soil::SolverStats& stats = parts_->soil.stats();
  SoilCounts out;
  out.steps = stats.steps;
  out.particle_steps = stats.particle_steps;
  out.particles = stats.particles;
  out.particles_peak = stats.particles_peak;
  out.rebins = stats.rebins;
  out.activated_columns = stats.wakes;
  out.deposited_blocks = stats.deposits;
  out.shell_crossings = stats.shell_crossings;
  return out;
}

void World::keep_soil_energy() {
  if (parts_->soil.energy() == nullptr) parts_->soil.record_energy(true);
}

std::optional<SoilEnergy> World::soil_energy() const {
  const soil::EnergyAccount* account = parts_->soil.energy();
  if (account == nullptr) return std::nullopt;
  SoilEnergy out;
  soil::report_energy(*account, [&](const char* name, double joule) {
    out.push_back({name, joule});
  });
  return out;
}

/// Recounted from columns and particles at each call: it proves, it does not remember.
MassLedger World::mass_ledger() const {
  // The error is summed before the parts are moved out.
  soil::Ledger sums = parts_->soil.ledger();
  const std::int64_t error = sums.error();
  return {std::move(sums.columns), std::move(sums.particles), std::move(sums.left_site),
          std::move(sums.inserted), error};
}

/// By the particles' ids, so that sums over it are repeatable to the bit.
std::vector<ActiveParticle> World::loose_soil() const {
  std::vector<ActiveParticle> out;
  for (const soil::Particle& p : parts_->soil.particles()) {
    // Particles know their block; where blocks begin on the site is the grid's to know.
    const auto [ix, iy] = parts_->soil.grid().column_of(p);
    out.push_back({ix, iy, p.soil, p.mass});
  }
  return out;
}

/// Of the exchange's stopwatches: what is neither vehicle nor soil nor ground is the caller's.
WallTimes World::wall_times() const {
  const coupling::TimeShare& share = parts_->coupling.time_share();
  return {share.vehicle, share.soil, share.ground};
}
std::vector<std::pair<std::string, double>> World::soil_stage_times() const {
  return parts_->soil.stage_times();
}

/// The head first and the ground next: who wants no more than the ground reads no farther
/// (sim/snapshot.h). The order of the parts is the order in which one change reaches the next
/// within a step.
void World::visit(Archive& a) {
  WorldParts& p = *parts_;
  SnapshotHead head{p.description.name, p.dt, p.steps};
  a("head", head);
  // Time is steps x dt, so the snapshot's step goes on whatever control rate chose it, as long as
  // it is stable here. No control rate makes it shorter than half the longest, or than its own
  // period.
  const double least = std::min(0.5 * p.longest_step, 1 / kHighestRate);
  a.require(head.dt >= least * (1 - kRounding) && head.dt <= p.longest_step * (1 + kRounding),
            "head/dt",
            "the snapshot has another base step than this scene can have; load it with the same "
            "solver settings");
  if (a.loading()) {
    p.steps = head.steps;
    p.dt = head.dt;
  }
  a("ground", p.ground);
  a("soil", p.soil);
  a("dynamic_machines", *p.dynamic);
  a("kinematic_machines", *p.kinematic);
  a("coupling", p.coupling);
  // A scene without encoders keeps the hash that it had before there were any; two scenes that
  // differ in theirs differ in what they start from.
  if (p.has_encoders())
    a.section("encoders", 1, [&] {
      for (std::size_t m = 0; m < p.encoders.size(); ++m)
        a.item(m, [&] { a("machine", p.encoders[m]); });
    });
  // Always there, so that a world without samplers notices those of a snapshot.
  a.section("samplers", 2, [&] {
    a.constant("count", p.samplers.size(),
               "the snapshot has another number of samplers than the world; add the same samplers, "
               "then load");
    for (std::size_t i = 0; i < p.samplers.size(); ++i) a.item(i, [&] { p.samplers[i]->visit(a); });
    a("arrays", p.arrays);
  });
}

/// Of the world alone; a session's hash has its operators in it.
std::string World::state_hash() const {
  StateHash sum;
  sum.value(parts_->start_hash);
  add_to_hash(sum, *this);
  return sum.hex();
}
const scene::Parameters& World::start() const { return parts_->start; }
std::uint64_t World::start_hash() const { return parts_->start_hash; }

/// Each part by itself, so that two runs compared row by row show which of them parted first.
std::vector<std::pair<std::string, std::string>> World::hash_parts() const {
  std::vector<std::pair<std::string, std::string>> out;
  // Each part starts a sum of its own.
  const auto add = [&out](const char* name, const auto& part) {
    out.emplace_back(name, hash_of(part).hex());
  };
  StateHash start;
  start.value(parts_->start_hash);
  out.emplace_back("start", start.hex());
  add("ground", parts_->ground);
  add("soil", parts_->soil);
  add("dynamic_machines", *parts_->dynamic);
  add("kinematic_machines", *parts_->kinematic);
  add("coupling", parts_->coupling);
  if (parts_->has_encoders()) {
    StateHash sum;
    for (const vehicle::Encoders& encoders : parts_->encoders) add_to_hash(sum, encoders);
    out.emplace_back("encoders", sum.hex());
  }
  if (!parts_->samplers.empty()) add("arrays", parts_->arrays);
  for (const auto& slot : parts_->samplers) add(slot->name().c_str(), *slot);
  return out;
}

}  // namespace navvy::sim
