// SPDX-License-Identifier: Apache-2.0
#include "sim/world.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/error.h"
#include "core/log.h"
#include "heightfield/site.h"
#include "sim/world_channels.h"

namespace navvy::sim {
namespace {

constexpr double kToolSpeed = 2.0;  // [m/s] fastest tip for which the base step must be stable

std::unique_ptr<vehicle::Engine> bullet(const scene::World& world) {
  return vehicle::make_bullet_engine(world.gravity);
}

/// The site; what was found in a terrain file goes to the log.
heightfield::Ground make_site(const scene::World& world) {
  std::string report;
  heightfield::Ground ground = heightfield::make_ground(world, &report);
  if (!report.empty()) log_info(report);
  return ground;
}

}  // namespace

struct World::State {
  State(scene::World world, device::Device& device)
      : description(std::move(world)),
        ground(make_site(description)),
        dynamic(bullet(description)),
        kinematic(vehicle::make_kinematic_engine()),
        soil(device, description, ground),
        coupling(description, *dynamic, *kinematic, soil, ground) {
    dt = std::min(description.solver.max_step, soil.step_limit(kToolSpeed));
    if (!(dt > 0) || !std::isfinite(dt))
      throw InputError(Fault{Fault::Severity::kError, description.file, 0, "navvy:solver", std::to_string(dt),
                             "the base step must be positive and finite",
                             "check cell, courant and the soils' stiffness"});
    for (const scene::AwakeSoil& awake : description.ground.awake) wake(awake);
    for (const coupling::ToolLoad& tool : coupling.tools()) load_bed(tool);
  }
  void load_bed(const coupling::ToolLoad& tool) {
    const scene::MachineInWorld& placed = description.machines[static_cast<std::size_t>(tool.machine)];
    if (!(placed.load.mass > 0) || !placed.machine.is_bed(tool.shell)) return;
    const Pose X_WL = coupling.engine(tool.machine).link(coupling.index(tool.machine), tool.link).X_WL;
    try {
      soil.fill(tool.tool, X_WL, std::max(0, description.soil_index(placed.load.soil)), placed.load.mass);
    } catch (const InputError& error) {
      Fault fault = error.faults().front();
      fault.file = description.file;
      fault.element = "include[" + placed.name + "]/" + fault.element;
      throw InputError(fault);
    }
  }
  void wake(const scene::AwakeSoil& awake) {
    const auto cell = [&](double metres, double from, int cells) {
      return static_cast<int>(std::clamp(std::round((metres - from) / ground.cell()), 0.0, static_cast<double>(cells)));
    };
    const Vec2 from = ground.origin();
    soil.wake({cell(awake.min.x(), from.x(), ground.nx()), cell(awake.min.y(), from.y(), ground.ny()),
               cell(awake.max.x(), from.x(), ground.nx()), cell(awake.max.y(), from.y(), ground.ny())},
              awake.bottom);
  }

  scene::World description;
  heightfield::Ground ground;
  std::unique_ptr<vehicle::Engine> dynamic, kinematic;
  soil::Solver soil;
  coupling::Coupling coupling;
  Inputs inputs;
  Outputs outputs;
  double dt = 0;
  std::uint64_t steps = 0;
};

World::World(scene::World description, device::Device& device)
    : state_(std::make_unique<State>(std::move(description), device)) {
  add_channels(*this, state_->inputs, state_->outputs);
}

World::~World() = default;

const scene::World& World::description() const { return state_->description; }
double World::dt() const { return state_->dt; }
std::uint64_t World::steps() const { return state_->steps; }
double World::time() const { return static_cast<double>(state_->steps) * state_->dt; }

void World::step() {
  state_->coupling.step(state_->dt);
  ++state_->steps;
}

const std::vector<Channel>& World::inputs() const { return state_->inputs.channels(); }
const std::vector<Channel>& World::outputs() const { return state_->outputs.channels(); }
int World::input(const std::string& name) const {
  return require_channel(state_->inputs.find(name), inputs(), name, "input");
}
int World::output(const std::string& name) const {
  return require_channel(state_->outputs.find(name), outputs(), name, "output");
}

void World::set(int input, double value) {
  if (!std::isfinite(value))
    throw InputError(Fault{Fault::Severity::kError, "", 0, inputs().at(static_cast<std::size_t>(input)).name,
                           std::to_string(value), "an input must be a finite number", "send a number"});
  state_->inputs.function(input)(value);
}
double World::get(int output) const { return state_->outputs.function(output)(); }

void World::set_joint(int machine, int joint, const vehicle::JointInput& input) {
  state_->coupling.engine(machine).set_joint(state_->coupling.index(machine), joint, input);
}
void World::set_drive(int machine, const vehicle::DriveInput& input) {
  state_->coupling.engine(machine).set_drive(state_->coupling.index(machine), input);
}
vehicle::DriveInput World::drive(int machine) const {
  return state_->coupling.engine(machine).drive(state_->coupling.index(machine));
}
vehicle::JointState World::joint(int machine, int joint) const {
  return state_->coupling.engine(machine).joint(state_->coupling.index(machine), joint);
}
vehicle::LinkState World::link(int machine, int link) const {
  return state_->coupling.engine(machine).link(state_->coupling.index(machine), link);
}
vehicle::WheelState World::wheel(int machine, int wheel) const {
  return state_->coupling.engine(machine).wheel(state_->coupling.index(machine), wheel);
}
vehicle::PumpState World::pump(int machine) const {
  return state_->coupling.engine(machine).pump(state_->coupling.index(machine));
}
double World::work(int machine) const { return state_->coupling.engine(machine).work(state_->coupling.index(machine)); }
const heightfield::Ground& World::ground() const { return state_->ground; }
const soil::Solver& World::soil() const { return state_->soil; }
soil::Solver& World::soil() { return state_->soil; }
const coupling::Coupling& World::coupling() const { return state_->coupling; }
const vehicle::Engine& World::engine(int machine) const { return state_->coupling.engine(machine); }
int World::engine_index(int machine) const { return state_->coupling.index(machine); }

void World::hash(StateHash& hash) const {
  hash.value(state_->steps);
  state_->ground.hash(hash);
  state_->soil.hash(hash);
  state_->dynamic->hash(hash);
  state_->kinematic->hash(hash);
  state_->coupling.hash(hash);
}

std::string World::state_hash() const {
  StateHash sum;
  hash(sum);
  return sum.hex();
}

std::vector<std::pair<std::string, std::string>> World::hash_parts() const {
  std::vector<std::pair<std::string, std::string>> out;
  const auto add = [&out](const char* name, const auto& part) {
    StateHash sum;
    part.hash(sum);
    out.emplace_back(name, sum.hex());
  };
  add("ground", state_->ground);
  add("soil", state_->soil);
  add("dynamic_machines", *state_->dynamic);
  add("kinematic_machines", *state_->kinematic);
  add("coupling", state_->coupling);
  return out;
}

void World::save(StateWriter& writer) const {
  writer.begin("world", 1);
  writer.text(state_->description.name);
  writer.value(state_->dt);
  writer.value(state_->steps);
  writer.end();
  state_->ground.save(writer);
  state_->soil.save(writer);
  state_->dynamic->save(writer);
  state_->kinematic->save(writer);
  state_->coupling.save(writer);
}

void World::load(StateReader& reader) {
  reader.begin("world", 1);
  const std::string name = reader.text();
  const auto dt = reader.value<double>();
  state_->steps = reader.value<std::uint64_t>();
  reader.end();
  if (name != state_->description.name || dt != state_->dt)
    throw InputError(Fault{Fault::Severity::kError, "snapshot", 0, "world", name,
                           "the snapshot belongs to another scene or another base step",
                           "load it into '" + name + "' with the same solver settings"});
  state_->ground.load(reader);
  state_->soil.load(reader);
  state_->dynamic->load(reader);
  state_->kinematic->load(reader);
  state_->coupling.load(reader);
}

}  // namespace navvy::sim
