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
#include "sim/timing.h"

namespace navvy::sim {
namespace {

constexpr double kToolSpeed = 2.0;  // [m/s] fastest tip for which the base step must be stable

/// The site; what was found in a terrain file goes to the log.
heightfield::Ground make_site(const scene::Scene& world) {
  // A map may have gaps or an odd datum: worth a line to the user, no fault.
  std::string report;
  heightfield::Ground ground = heightfield::make_ground(world, &report);
  if (!report.empty()) log_info(report);
  return ground;
}

}  // namespace

/// In the order of the members: ground under machines, engines and soil under the exchange that
/// binds them.
WorldParts::WorldParts(scene::Scene world, device::Device& device)
    : description(std::move(world)),
      ground(make_site(description)),
      dynamic(vehicle::make_bullet_engine(description.gravity, description.materials)),
      kinematic(vehicle::make_kinematic_engine()),
      soil(device, description, ground),
      coupling(description, *dynamic, *kinematic, soil, ground) {
  start = start_of(description, ground);
  start_hash = hash_of_start(start);
  // The step of everything is what waves in the stiffest soil and the fastest tool allow.
  longest_step = std::min(description.solver.max_step, soil.step_limit(kToolSpeed));
  const double rate = description.solver.control_rate;
  dt = base_step(longest_step, rate > 0 ? 1 / rate : 0);
  if (!(dt > 0) || !std::isfinite(dt))
    throw InputError(Fault{Fault::Severity::kError, description.file, 0, "navvy:solver",
                           std::to_string(dt), "the base step must be positive and finite",
                           "check cell, courant and the soils' stiffness"});
  // Chance is by machine, so that one more encoder leaves those of other machines as they were.
  Random seeds(description.seed);
  for (int m = 0; m < static_cast<int>(description.machines.size()); ++m)
    encoders.emplace_back(description.machines[static_cast<std::size_t>(m)].machine,
                          coupling.engine(m), coupling.index(m), seeds.next());
  // Soil that starts awake before loads are filled in: beds stand where machines stand now.
  check_active(description, ground);
  for (const scene::ActiveSoil& active : description.ground.active) wake(active);
  for (const coupling::ToolLoad& tool : coupling.tools()) fill_bed(tool);
}

void WorldParts::advance_encoders() {
  for (std::size_t m = 0; m < encoders.size(); ++m)
    encoders[m].advance(coupling.engine(static_cast<int>(m)), coupling.index(static_cast<int>(m)));
}

bool WorldParts::has_encoders() const {
  return std::any_of(encoders.begin(), encoders.end(),
                     [](const vehicle::Encoders& e) { return e.size() > 0; });
}

void WorldParts::fill_bed(const coupling::ToolLoad& tool) {
  const scene::MachineInWorld& placed =
      description.machines[static_cast<std::size_t>(tool.machine)];
  // Only the first bed is loaded; buckets start empty.
  if (!(placed.load.mass > 0) || !placed.machine.is_bed(tool.shell)) return;
  // Filled where the bed is: a dumper on a slope starts with its load against the low side.
  const Pose X_WL =
      coupling.engine(tool.machine).link(coupling.index(tool.machine), tool.link).X_WL;
  try {
    soil.fill(tool.tool, X_WL, std::max(0, description.soil_index(placed.load.soil)),
              placed.load.mass);
  } catch (const InputError& error) {
    // The solver knows no file: the message gets the place in the scene that asked for the load.
    Fault fault = error.faults().front();
    fault.file = description.file;
    fault.line = placed.line;
    fault.element = "include[" + placed.name + "]/" + fault.element;
    throw InputError(fault);
  }
}

void WorldParts::wake(const scene::ActiveSoil& active) {
  soil.wake(active_columns(active, ground), active.bottom);
}

}  // namespace navvy::sim
