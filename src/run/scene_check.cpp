// SPDX-License-Identifier: Apache-2.0
#include "run/scene_check.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <sstream>
#include <utility>

#include "core/math.h"
#include "earthwork/pit_planner.h"
#include "planner/map_path_planner.h"
#include "record/map_recorder.h"
#include "run/slice_check.h"
#include "sensor/make_sensors.h"
#include "session/program_check.h"
#include "sim/start_check.h"

namespace navvy::run {
namespace {

/// Returns how a machine stands after its first second.
std::string standing(const std::string& name, const vehicle::Stability& stands, bool falling) {
  char text[160];
  const double tilt = degrees(stands.tilt);
  if (falling)
    std::snprintf(text, sizeof text, "does not stand after a second: it is still falling");
  else if (stands.margin == 0)
    std::snprintf(text, sizeof text, "stands: tilt %.1f deg, on a support polygon without area",
                  tilt);
  else
    std::snprintf(text, sizeof text,
                  "stands: tilt %.1f deg, centre of mass %.2f m %s its support polygon", tilt,
                  std::abs(stands.margin), stands.margin > 0 ? "within" : "outside");
  return "'" + name + "' " + text;
}

/// Returns what files of the ground cost on a large site; empty for other sites.
std::string cost_of_files(const scene::Scene& scene) {
  // Below, each file takes less than a second.
  constexpr double kLarge = 25e6;
  // Measured: 2.5 s for a flat site of 1e8 columns, nearly all of it compression.
  constexpr double kSecondsPerColumn = 25e-9;
  const Vec2 cells = scene.ground.size / scene.solver.cell;
  const double columns = cells.x() * cells.y();
  if (columns < kLarge) return "";
  char text[240];
  std::snprintf(text, sizeof text,
                "the site has %.3g columns: each of terrain_start.tif and terrain_end.tif takes "
                "about %.0f s and up to %.1f GB; a larger cell_m or a smaller size_m costs less",
                columns, std::ceil(columns * kSecondsPerColumn), columns * sizeof(float) / 1e9);
  return text;
}

/// Returns what active soil costs in small cells; empty for other cells.
std::string cost_of_soil(const scene::Scene& scene) {
  // A cubic metre in cells of 3 cm takes 61 MiB; above, a dig rarely needs as much as the program.
  constexpr double kSmall = 0.03;
  // Of a particle with its lists (core/limits.h, kParticles), and particles in a cell.
  constexpr double kBytes = 216, kPerCell = 8;
  const double cell = scene.solver.cell, most = scene.solver.max_particles;
  if (!(cell < kSmall)) return "";
  const double each = kPerCell / (cell * cell * cell);
  char text[240];
  std::snprintf(
      text, sizeof text,
      "cells of %.3g m: a cubic metre of active soil takes %.3g particles and %.0f MiB of "
      "the device; max_particles allows %.3g m3 and %.0f MiB",
      cell, each, each * kBytes / (1 << 20), most / each, most * kBytes / (1 << 20));
  return text;
}

/// Splits a text into lines.
void add_lines(std::vector<std::string>& lines, const std::string& text) {
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) lines.push_back(line);
}

/// Adds a fault, unless the same one is there already.
void add_new(std::vector<Fault>& faults, Fault fault) {
  if (std::none_of(faults.begin(), faults.end(),
                   [&](const Fault& one) { return one.text() == fault.text(); }))
    faults.push_back(std::move(fault));
}

}  // namespace

SceneCheck check_scene(const scene::Scene& scene) {
  SceneCheck out;
  // The test that a run makes before it starts.
  out.faults = session::check_programs(scene, {planner::path_planners(), earthwork::job_planners()},
                                       &out.notes);
  for (Fault& fault : record::check_records(scene)) out.faults.push_back(std::move(fault));
  for (Fault& fault : check_slices(scene)) out.faults.push_back(std::move(fault));
  // The check of the programs has reported a ground that cannot be made.
  for (Fault& fault : sensor::check_sensors(scene)) add_new(out.faults, std::move(fault));
  // The machines settle for a second on resting soil, without a device.
  sim::StartCheck start = sim::check_start(scene);
  add_lines(out.notes, start.terrain);
  add_lines(out.notes, start.design);
  add_lines(out.notes, cost_of_files(scene));
  add_lines(out.notes, cost_of_soil(scene));
  for (std::size_t m = 0; m < start.standing.size(); ++m)
    if (start.standing[m].free)
      out.notes.push_back(standing(scene.machines[m].name, start.standing[m], start.falling[m]));
    else if (!start.without_wheels[m].empty())
      out.notes.push_back("'" + scene.machines[m].name + "' " + start.without_wheels[m]);
  // The check of the programs has reported a ground that cannot be made.
  for (Fault& fault : start.faults) add_new(out.faults, std::move(fault));
  return out;
}

}  // namespace navvy::run
