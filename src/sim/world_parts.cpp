// SPDX-License-Identifier: Apache-2.0
#include "sim/world_parts.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "core/error.h"
#include "core/log.h"
#include "heightfield/make_ground.h"
#include "sim/snapshot.h"
#include "sim/start_placing.h"
#include "sim/step_length.h"

namespace navvy::sim {
namespace {

constexpr double kHighestRate = 1e5;  // [1/s] of a controller, as scenes may ask for
constexpr double kRounding = 1e-8;    // of a step that is the quotient of two times

/// Builds the ground and logs the report on a terrain file.
heightfield::Ground make_site(const scene::Scene& world) {
  // A map may have gaps or an unusual datum: worth a line to the user, but no fault.
  std::string report;
  heightfield::Ground ground = heightfield::make_ground(world, &report);
  if (!report.empty()) log_info(report);
  return ground;
}

/// Makes the engine of the dynamic machines: the caller's, or the one built on Bullet.
std::unique_ptr<vehicle::PhysicsEngine> make_dynamic(
    const scene::Scene& world, const vehicle::PhysicsEngineFactory& make_engine) {
  std::unique_ptr<vehicle::PhysicsEngine> engine =
      make_engine ? make_engine(world.gravity, world.materials)
                  : vehicle::make_bullet_engine(world.gravity, world.materials);
  if (engine != nullptr) return engine;
  throw InputError(Fault{Fault::Severity::kError, world.file, 0, "physics engine", "null",
                         "the factory must return an engine",
                         "return a new vehicle::PhysicsEngine from it"});
}

}  // namespace

/// Follows the order of the members: ground under machines, engines and soil under the coupling
/// that joins them.
WorldParts::WorldParts(scene::Scene world, device::Device& device,
                       const vehicle::PhysicsEngineFactory& make_engine)
    : description(std::move(world)),
      ground(make_site(description)),
      dynamic(make_dynamic(description, make_engine)),
      kinematic(vehicle::make_kinematic_engine()),
      soil(device, description, ground),
      coupling(description, *dynamic, *kinematic, soil, ground),
      forces(description) {
  start = start_of(description, ground);
  start_hash = hash_of_start(start);
  longest_step = sim::longest_step(description);
  dt = starting_step(description);
  if (!(dt > 0) || !std::isfinite(dt))
    throw InputError(Fault{Fault::Severity::kError, description.file, 0, "navvy:solver",
                           std::to_string(dt), "the base step must be positive and finite",
                           "check cell, courant and the soils' stiffness"});
  // One seed per machine, so that another encoder does not change those of other machines.
  Random seeds(description.seed);
  for (int m = 0; m < static_cast<int>(description.machines.size()); ++m)
    encoders.emplace_back(description.machines[static_cast<std::size_t>(m)].machine,
                          coupling.engine(m), coupling.index(m), seeds.next());
  // Activate soil before filling loads in: beds are where machines stand now.
  check_active(description, ground);
  for (const scene::ActiveSoil& active : description.ground.active) activate(active);
  for (const coupling::ToolLoad& tool : coupling.tools()) fill_bed(tool);
  forget_values();
}

void WorldParts::advance_encoders() {
  for (std::size_t m = 0; m < encoders.size(); ++m)
    encoders[m].advance(coupling.engine(static_cast<int>(m)), coupling.index(static_cast<int>(m)));
}

bool WorldParts::has_encoders() const {
  return std::any_of(encoders.begin(), encoders.end(),
                     [](const vehicle::Encoders& e) { return e.size() > 0; });
}

// Loads are part of the start, so they are counted as inserted mass.
void WorldParts::fill_bed(const coupling::ToolLoad& tool) {
  const scene::MachineInWorld& placed =
      description.machines[static_cast<std::size_t>(tool.machine)];
  // Only the first bed is loaded; buckets start empty.
  if (!(placed.load.mass > 0) || !placed.machine.is_bed(tool.shell)) return;
  // Fill at the bed's pose: a dumper on a slope starts with its load against the low side.
  const Pose X_WL =
      coupling.engine(tool.machine).link(coupling.index(tool.machine), tool.link).X_WL;
  try {
    soil.fill(tool.tool, X_WL, std::max(0, description.soil_index(placed.load.soil)),
              placed.load.mass);
  } catch (const InputError& error) {
    // The solver does not know the file; add the line of the scene that asked for the load.
    Fault fault = error.faults().front();
    fault.file = description.file;
    fault.line = placed.line;
    fault.element = "include[" + placed.name + "]/" + fault.element;
    throw InputError(fault);
  }
}

void WorldParts::forget_values() {
  payloads.assign(coupling.tools().size(), std::nullopt);
  stabilities.assign(description.machines.size(), std::nullopt);
}

/// Visits the head first and the ground next: a reader of the ground alone stops there
/// (sim/snapshot.h). The order of the parts is the order in which a change reaches them in a step.
void WorldParts::visit(Archive& a) {
  SnapshotHead head{description.name, dt, steps};
  a("head", head);
  // Time is steps x dt, so a run continues with the snapshot's step, whatever control rate set it,
  // if the step is stable here. No control rate makes it shorter than half the longest step or its
  // own period.
  const double least = std::min(0.5 * longest_step, 1 / kHighestRate);
  a.require(head.dt >= least * (1 - kRounding) && head.dt <= longest_step * (1 + kRounding),
            "head/dt",
            "the snapshot has another base step than this scene can have; load it with the same "
            "solver settings");
  if (a.loading()) {
    steps = head.steps;
    dt = head.dt;
    forget_values();
  }
  a("ground", ground);
  a("soil", soil);
  a("dynamic_machines", *dynamic);
  a("kinematic_machines", *kinematic);
  a("coupling", coupling);
  // Scenes without encoders keep the hash that they had before encoders existed. Scenes with
  // different encoders differ in their start.
  if (has_encoders())
    a.section("encoders", 1, [&] {
      for (std::size_t m = 0; m < encoders.size(); ++m)
        a.item(m, [&] { a("machine", encoders[m]); });
    });
  if (forces.size() > 0) a.section("link_forces", 1, [&] { a("forces", forces); });
  // Always present, so that a world without samplers notices the samplers of a snapshot.
  a.section("samplers", 3, [&] {
    a.constant("count", samplers.size(),
               "the snapshot has another number of samplers than the world; add the same samplers, "
               "then load");
    for (std::size_t i = 0; i < samplers.size(); ++i)
      a.item(i, [&] {
        if (samplers[i]->hashed()) return samplers[i]->visit(a);
        a.unhashed("the sampler changes nothing that a run computes",
                   [&] { samplers[i]->visit(a); });
      });
    a("arrays", arrays);
  });
}

void WorldParts::activate(const scene::ActiveSoil& active) {
  soil.activate(active_columns(active, ground), active.bottom);
}

void require_hitch(const scene::Scene& scene, int hitch) {
  if (hitch >= 0 && hitch < static_cast<int>(scene.hitches.size())) return;
  throw InputError(Fault{Fault::Severity::kError, "", 0, "hitch", std::to_string(hitch),
                         "the scene has no such hitch", "add <navvy:hitch> to the scene"});
}

}  // namespace navvy::sim
