// SPDX-License-Identifier: Apache-2.0
#include "sim/world.h"

#include <utility>

#include "core/error.h"
#include "sim/world_channels.h"
#include "sim/world_parts.h"

namespace navvy::sim {

/// Builds all parts before the first channel: channels hold handles into them.
World::World(scene::Scene description, device::Device& device,
             const vehicle::PhysicsEngineFactory& make_engine)
    : parts_(std::make_unique<WorldParts>(std::move(description), device, make_engine)) {
  add_channels(*this, parts_->inputs, parts_->outputs);
}

// Here, where the parts are a complete type.
World::~World() = default;

WorldParts& parts(World& world) { return *world.parts_; }
const WorldParts& parts(const World& world) { return *world.parts_; }

const scene::Scene& World::description() const { return parts_->description; }
const scene::Parameters& World::start() const { return parts_->start; }
double World::dt() const { return parts_->dt; }
double World::longest_step() const { return parts_->longest_step; }
std::uint64_t World::steps() const { return parts_->steps; }
double World::time() const { return parts_->time(); }

/// Samples last, so that all samplers see the same instant.
void World::step() {
  // First, as a step that fails leaves another state, too.
  parts_->forget_values();
  parts_->forces.push(parts_->coupling);
  parts_->coupling.step(parts_->dt);
  parts_->advance_encoders();
  ++parts_->steps;
  for (const auto& slot : parts_->samplers)
    if (slot->due(steps(), dt())) slot->sample(*this, time());
}

Inputs& World::inputs() { return parts_->inputs; }
const Inputs& World::inputs() const { return parts_->inputs; }
const Outputs& World::outputs() const { return parts_->outputs; }

void World::watch(const std::string& link) {
  // Names of parts contain "::" and no slash, so the first slash ends the machine's name.
  const std::size_t slash = link.find('/');
  if (slash == std::string::npos)
    throw InputError(Fault{Fault::Severity::kError, "", 0, "watch", link,
                           "must be a machine and one of its links", "e.g. excavator/boom"});
  const MachineHandle of = machines().at(link.substr(0, slash));
  add_link(of.link(link.substr(slash + 1)), of.name(), parts_->outputs);
}

const ArrayOutputs& World::arrays() const { return parts_->arrays; }

void World::add(std::unique_ptr<Sampler> sampler) {
  // Each slot has its own address: outputs keep pointers to its numbers.
  parts_->samplers.push_back(
      std::make_unique<SamplerSlot>(std::move(sampler), parts_->outputs, parts_->arrays));
  // Recorders write their first row at the start, so readers must find a value then.
  parts_->samplers.back()->sample(*this, time());
}

const heightfield::Ground& World::ground() const { return parts_->ground; }

void World::reshape(const std::function<void(heightfield::Ground&)>& change) {
  if (parts_->steps > 0) throw Error("the ground can be reshaped only before the first step");
  const std::vector<std::int64_t> before = parts_->ground.mass_change();
  change(parts_->ground);
  if (parts_->ground.mass_change() != before)
    throw Error("a change of the ground must keep the mass of each soil");
}

void World::keep_soil_energy() {
  if (parts_->soil.energy() == nullptr) parts_->soil.record_energy(true);
}

WallTimes World::wall_times() const {
  const coupling::TimeShare& share = parts_->coupling.time_share();
  return {share.vehicle, share.soil, share.ground};
}

void World::visit(Archive& a) { parts_->visit(a); }

}  // namespace navvy::sim
