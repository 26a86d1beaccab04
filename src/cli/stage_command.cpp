// SPDX-License-Identifier: Apache-2.0
// `navvy stage`: writes a snapshot of a scene whose job is done in part.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "cli/commands.h"
#include "cli/exit_code.h"
#include "cli/input_files.h"
#include "cli/scene_options.h"
#include "control/activity_step.h"
#include "control/step_kinds.h"
#include "core/error.h"
#include "core/printable.h"
#include "core/sealed.h"
#include "device/device.h"
#include "earthwork/part_done.h"
#include "earthwork/pit_planner.h"
#include "planner/map_path_planner.h"
#include "scene_io/ordered_program.h"
#include "sensor/make_sensors.h"
#include "session/session.h"
#include "sim/occupied_areas.h"

namespace navvy::cli {
namespace {

/// Options of the command line.
struct StageCommand {
  SceneOptions scene;
  double done = 0.5;
  std::string machine, out;
};

/// The job of a machine: its index in the scene, the number of the step from 1, and its pit.
struct Job {
  int machine = 0;
  std::size_t step = 1;
  control::PitJob pit;
};

/// Returns the first job of the program of `machine`, or of any machine if it is empty.
Job job_of(const scene::Scene& scene, const std::string& machine) {
  if (!machine.empty() && scene.machine_index(machine) < 0)
    throw InputError(Fault{Fault::Severity::kError, scene.file, 0, "--machine", machine,
                           "is no machine of the scene", "navvy check SCENE lists them"});
  for (std::size_t m = 0; m < scene.machines.size(); ++m) {
    if (!machine.empty() && scene.machines[m].name != machine) continue;
    const std::vector<scene::ProgramStep>& steps = scene.machines[m].program.steps;
    for (std::size_t i = 0; i < steps.size(); ++i)
      if (const std::optional<control::PitJob> pit = control::step_of(steps[i]).pit_job())
        return {static_cast<int>(m), i + 1, *pit};
  }
  throw InputError(Fault{Fault::Severity::kError, scene.file, 0, "navvy:program", machine,
                         "has no step that can begin in the middle", "add a dig_area or a grade"});
}

/// Refuses a scene in which soil moves from the start.
void require_still(const scene::Scene& scene) {
  if (!scene.ground.active.empty())
    throw InputError(Fault{Fault::Severity::kError, scene.file, 0, "navvy:ground/active", "",
                           "a site with active soil cannot be staged", "remove it"});
}

/// Moves the soil of the job. Faults of the job name the scene and the step.
earthwork::PartDone move_soil(const StageCommand& options, const scene::Scene& scene,
                              const Job& job, session::Session& session) {
  const sim::World& world = session.world();
  const sim::MachineHandle machine = world.machines().at(job.machine);
  const std::vector<heightfield::OccupiedArea> bodies =
      sim::occupied_areas(world, sim::all_bodies(scene));
  earthwork::PartDone out;
  try {
    session.reshape([&](heightfield::Ground& ground) {
      out = earthwork::stage(job.pit, machine.description(), machine.link(0).pose(), options.done,
                             scene.seed, bodies, ground);
    });
  } catch (const InputError& error) {
    std::vector<Fault> faults = error.faults();
    const scene::Program& program = scene.machines[static_cast<std::size_t>(job.machine)].program;
    for (Fault& one : faults) {
      if (one.element.rfind("--", 0) == 0) continue;
      one.file = scene.file;
      one.line = job.step <= program.lines.size() ? program.lines[job.step - 1] : 0;
      one.element = machine.name() + "/navvy:program/step " + std::to_string(job.step) + "/" +
                    program.steps[job.step - 1]->element() + "/" + one.element;
    }
    throw InputError(std::move(faults));
  }
  return out;
}

/// Returns the options of values as the run that goes on needs them.
std::string values_of(const SceneOptions& scene) {
  std::string out;
  const auto add = [&](const char* option, const std::string& value) {
    if (!value.empty()) out += std::string(" ") + option + " '" + value + "'";
  };
  add("--preset", scene.preset);
  for (const std::string& one : scene.set) add("--set", one);
  add("--terrain", scene.terrain);
  add("--at", scene.at);
  add("--size", scene.size);
  add("--soil", scene.soil);
  if (scene.seed) add("--seed", std::to_string(*scene.seed));
  return out;
}

int stage(const StageCommand& options) {
  const scene::Scene scene = options.scene.load();
  require_still(scene);
  const Job job = job_of(scene, options.machine);
  const std::string out = options.out.empty() ? scene.name + ".snapshot" : options.out;
  require_apart(out, {out}, {scene.file, scene.ground.file, scene.design.file});
  std::error_code unreadable;
  if (std::filesystem::exists(out, unreadable) && !is_sealed(out))
    throw InputError(Fault{Fault::Severity::kError, "", 0, "--out", out,
                           "exists and is no snapshot, so it is not replaced", "name a new file"});
  device::Device device(options.scene.device);
  session::Session session(
      scene, device,
      control::Planners{planner::path_planners(), earthwork::job_planners(),
                        scene_io::ordered_program_reader(control::step_kinds())});
  const earthwork::PartDone done = move_soil(options, scene, job, session);
  // Afterwards, as sensors take their first sample at once.
  for (std::unique_ptr<sim::Sampler>& one : sensor::make_sensors(session.world()))
    session.add(std::move(one));
  session.save(out);
  std::printf("%s: %.1f m3 are dug, %.0f %% of the job; the spoil is %.2f m high\n",
              printable(out).c_str(), done.volume, 100 * done.share, done.heap);
  std::printf("to go on from there: navvy run %s%s --resume %s\n",
              printable(options.scene.file).c_str(), printable(values_of(options.scene)).c_str(),
              printable(out).c_str());
  return kOk;
}

}  // namespace

void add_stage(CLI::App& app, Action& action) {
  auto options = std::make_shared<StageCommand>();
  CLI::App* command =
      app.add_subcommand("stage", "write a snapshot of a scene whose job is done in part");
  options->scene.add_scene_to(*command);
  options->scene.add_values_to(*command);
  command->add_option("--done", options->done, "part of the job's volume that is dug")
      ->capture_default_str();
  command->add_option("--machine", options->machine,
                      "machine whose job it is; without it the first one with a dig_area or grade");
  command->add_option("--out", options->out,
                      "snapshot to write; without it SCENE.snapshot in the working directory");
  command->footer(
      "Soil is moved at once: the pit ahead of a face, the spoil loose and at rest where the\n"
      "machine dumps. --seed bends the face. Example: navvy stage jobs/pit --done 0.25 --seed 3");
  command->callback([options, &action] { action = [options] { return stage(*options); }; });
}

}  // namespace navvy::cli
