// SPDX-License-Identifier: Apache-2.0
// `navvy run`: a scene from start to results.
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>
#include <cstdio>
#include <map>
#include <memory>
#include <optional>

#include "cli/commands.h"
#include "cli/exit_code.h"
#include "cli/scene_options.h"
#include "cli/validators.h"
#include "control/step_kinds.h"
#include "core/error.h"
#include "core/log.h"
#include "core/printable.h"
#include "core/stopwatch.h"
#include "link/control_stdio.h"
#include "link/live_view.h"
#include "link/published_map.h"
#include "link/sensor_publisher.h"
#include "record/particle_recorder.h"
#include "report/page.h"
#include "run/simulation.h"
#include "run/start_checks.h"
#include "run/stop_signals.h"
#include "scene_io/ordered_program.h"

namespace navvy::cli {
namespace {

/// Options as parsed. Most are those of the simulation itself.
struct RunOptions {
  SceneOptions scene;
  run::SimulationOptions simulation;
  std::string control, pictures, particles;
  double control_rate = 50;
  link::PublishOptions publish;
  // Address at which readings of sensors are published; empty if they are not.
  std::string publish_sensors;
  // Port of the live page; no value: there is none.
  std::optional<int> view;
  bool quiet = false;
  bool no_report = false;
};

/// Shows progress in one line on a terminal, rewritten twice a second. Shows nothing when stderr is
/// a file or a pipe, or with `quiet`.
class ProgressLine {
 public:
  explicit ProgressLine(bool quiet) : on_(!quiet && isatty(STDERR_FILENO) != 0) {}
  void show(const run::RunProgress& p) {
    // A terminal is slower than a step.
    if (!on_ || watch_.seconds() < 0.5) return;
    watch_.restart();
    std::fprintf(stderr,
                 "\r%7.1f / %.0f s  x%.2f real time  %6d particles  cycle %d  %-10s  at most %3.0f "
                 "s left \033[K",
                 p.time, p.duration, p.real_time_factor, p.particles, p.cycles, p.phase.c_str(),
                 p.remaining);
    shown_ = true;
  }
  void end() {
    if (shown_) std::fprintf(stderr, "\n");
    shown_ = false;
  }

 private:
  bool on_;
  bool shown_ = false;
  Stopwatch watch_;
};

/// Adds the parts of the program to a run: progress line, signals, and what is published.
class ProgramObserver final : public run::RunObserver {
 public:
  explicit ProgramObserver(bool quiet) : line_(quiet), signals_(leave) {}

  void publish(const link::PublishOptions& options, const session::Session& session) {
    map_.emplace(options, session);
  }
  void publish_sensors(const std::string& address, const sim::World& world) {
    sensors_.emplace(world, address);
    log_info("readings of sensors on port " + std::to_string(sensors_->port()));
  }
  void view(run::Simulation& simulation, int port, bool controlled) {
    view_.emplace(simulation, port,
                  controlled ? "belong to the controller (--control) in this run" : "");
    // Standard output belongs to the controller where there is one.
    std::FILE* out = controlled ? stderr : stdout;
    std::fprintf(out, "view: %s\n", view_->address().c_str());
    std::fflush(out);
  }
  void show(const run::RunProgress& progress) { line_.show(progress); }
  /// Carries out what pages ask for, and waits while they pause the run.
  void before_step() {
    if (view_) view_->before_step(run::StopSignals::asked);
  }

  void after_step() override {
    if (map_) map_->observe();
    if (sensors_) sensors_->publish();
    if (view_) view_->after_step();
  }
  void restart() override {
    if (map_) map_->restart();
    if (sensors_) sensors_->restart();
    if (view_) view_->restart();
  }
  void closing() override {
    line_.end();
    signals_.obeyed();
  }
  void finish() override {
    if (view_) view_->finish();
    if (sensors_) sensors_->finish();
    if (map_) map_->finish();
  }

 private:
  /// Called on the thread of the signals, when the run does not react.
  [[noreturn]] static void leave(const char* message) {
    std::fprintf(stderr, "interrupted: %s\n", message);
    _exit(kInterrupted);
  }

  ProgressLine line_;
  run::StopSignals signals_;
  std::optional<link::PublishedMap> map_;
  std::optional<link::SensorPublisher> sensors_;
  std::optional<link::LiveView> view_;
};

/// Returns the folder of the results. It is named by the scene, not by its file: a scene read from
/// a run's folder goes back there.
std::string default_out(const scene::Scene& world) {
  return "out/" + (world.name.empty() ? "run" : world.name);
}

/// Returns the scene, with the control rate among its values: it is written beside the results.
scene::Scene load(const RunOptions& options, std::string& resolved) {
  SceneOptions scene = options.scene;
  if (!options.control.empty()) {
    char rate[40];
    *std::to_chars(rate, rate + sizeof rate - 1, options.control_rate).ptr = '\0';
    scene.set.push_back(std::string("solver.control_rate_hz=") + rate);
  }
  return scene.load(&resolved);
}

/// Runs to the end; a controller on standard input and output takes part where there is one.
run::RunEnd drive(const RunOptions& options, run::Simulation& simulation,
                  ProgramObserver& program) {
  std::optional<link::ControlStdio> control;
  if (!options.control.empty())
    control.emplace(simulation, options.control_rate, run::StopSignals::asked);
  run::LoopHooks hooks;
  // A signal comes first: the controller often goes away because of it.
  hooks.interrupted = [&] {
    return run::StopSignals::asked() ? run::StopSignals::name() : control ? control->gone() : "";
  };
  hooks.progress = [&](const run::RunProgress& progress) { program.show(progress); };
  hooks.before_step = [&] {
    program.before_step();
    return !control || control->exchange();
  };
  return simulation.run_to_end(hooks);
}

/// Prints the programs that did not reach their end, one a line.
void print_programs(std::FILE* out, const session::Session& session) {
  for (const session::ProgramReport& report : session.programs()) {
    if (report.by_inputs() || report.last().state == control::StepState::kDone) continue;
    const std::string& name =
        session.world().description().machines[static_cast<std::size_t>(report.machine)].name;
    std::fprintf(
        out, "incomplete: %s\n",
        printable(session::report_line(report, name, "the controller ended the run")).c_str());
  }
}

/// Returns the names of the forms of pictures.
std::map<std::string, record::PictureFormat> picture_formats() {
  return {{"video", record::PictureFormat::kVideo}, {"png", record::PictureFormat::kPng}};
}

/// Returns what RATE or RATE,FORMAT asks for. @throws InputError for a text of another form; rate
/// and format themselves are checked by the simulation.
record::ParticleRecord particle_record(const std::string& text) {
  const std::size_t comma = text.find(',');
  const std::size_t length = std::min(comma, text.size());
  record::ParticleRecord out;
  const auto [end, code] = std::from_chars(text.data(), text.data() + length, out.rate);
  // A rate of 0 would silently record nothing.
  if (code != std::errc() || end != text.data() + length || out.rate == 0)
    throw InputError(Fault{Fault::Severity::kError, "", 0, "--particles", text,
                           "does not begin with a rate above 0 in files per simulated second",
                           "give RATE or RATE,FORMAT, for example 10,npz"});
  if (comma != std::string::npos) out.format = text.substr(comma + 1);
  record::check_particles(out);
  return out;
}

/// Prints what the pictures of the run cost.
void print_pictures(std::FILE* out, const run::RunEnd& end) {
  if (end.pictures == 0 || end.wall_time <= 0) return;
  std::fprintf(
      out,
      "pictures: %d, drawn in %.1f s (%.0f %% of the wall time), encoded beside the run in "
      "%.1f s of processor time (%.0f %%)\n",
      end.pictures, end.drawing_time, 100 * end.drawing_time / end.wall_time, end.encoding_time,
      100 * end.encoding_time / end.wall_time);
}

/// Makes the page of the run in the folder of its results. A run does not fail for want of a page.
void write_page(const RunOptions& options, const run::Simulation& simulation, std::FILE* out) {
  const std::string folder = simulation.results_folder();
  if (options.no_report || folder.empty()) return;
  const std::string file = folder + "/" + report::kPageName;
  try {
    report::write_page({folder}, file);
    std::fprintf(out, "report: %s\n", printable(file).c_str());
  } catch (const std::exception& error) {
    log(LogLevel::kWarning, std::string("no report of the run: ") + error.what());
  }
}

/// Prints how the run ended; returns the exit status.
int print_end(const RunOptions& options, const run::Simulation& simulation,
              const run::RunEnd& end) {
  // Standard output belongs to the controller where there is one.
  std::FILE* out = options.control.empty() ? stdout : stderr;
  if (end.reason == run::EndReason::kInterrupted)
    std::fprintf(out, "interrupted: %s, at %.6g s\n", end.cause.c_str(), end.time);
  else if (end.reason == run::EndReason::kForbidden)
    std::fprintf(out, "failed: %s\n", printable(end.cause).c_str());
  else if (end.reason == run::EndReason::kMissedGoal)
    std::fprintf(out, "%s\n", printable(end.cause).c_str());
  else
    print_programs(out, simulation.session());
  if (!options.quiet) print_pictures(out, end);
  std::fprintf(out, "results: %s/summary.json\n", printable(options.simulation.folder).c_str());
  write_page(options, simulation, out);
  if (end.reason == run::EndReason::kInterrupted) return kInterrupted;
  if (end.reason == run::EndReason::kForbidden) return kForbidden;
  if (end.reason == run::EndReason::kMissedGoal) return kMissedGoal;
  if (end.snapshot_missed) return kFile;
  // A duration on the command line asks for no more than that: a program that it cuts off is
  // reported, and no failure.
  const bool asked = end.reason == run::EndReason::kEndRequested ||
                     (end.reason == run::EndReason::kOutOfTime && options.scene.duration > 0);
  return end.reason == run::EndReason::kComplete || asked ? kOk : kIncomplete;
}

/// Runs a scene; returns the exit status.
int run_scene(RunOptions options) {
  if (!options.control.empty() && options.control != "stdio")
    throw InputError(Fault{Fault::Severity::kError, "", 0, "--control", options.control,
                           "only 'stdio' is known",
                           "omit it to let the programs of the scene drive"});
  // Before anything that may take long, such as a driver that compiles.
  ProgramObserver program(options.quiet || !options.control.empty());
  run::SimulationOptions& wanted = options.simulation;
  // Cheap checks come before the scene is loaded.
  run::check_resume(wanted.resume);
  if (!options.particles.empty()) wanted.particles = particle_record(options.particles);
  link::require_publishable(options.publish);
  if (!options.publish_sensors.empty())
    link::SensorPublisher::require_address(options.publish_sensors);
  if (options.view) link::LiveView::require_port(*options.view);
  scene::Scene scene = load(options, wanted.scene_text);
  if (wanted.folder.empty()) wanted.folder = default_out(scene);
  wanted.device = options.scene.device;
  wanted.read_program = scene_io::ordered_program_reader(control::step_kinds());
  wanted.replay = !options.no_report;
  if (!options.pictures.empty()) wanted.picture_format = picture_formats().at(options.pictures);
  if (!options.control.empty()) wanted.control_rate = options.control_rate;
  if (!options.quiet) wanted.note = log_info;
  run::Simulation simulation(std::move(scene), wanted);
  simulation.attach(program);
  try {
    if (!options.publish.place.empty()) program.publish(options.publish, simulation.session());
    if (!options.publish_sensors.empty())
      program.publish_sensors(options.publish_sensors, simulation.world());
    if (options.view) program.view(simulation, *options.view, !options.control.empty());
  } catch (const std::exception& error) {
    // The place was free when it was checked, but may be taken by now.
    simulation.fail(error.what());
    throw;
  }
  run::RunEnd end;
  try {
    end = drive(options, simulation, program);
  } catch (const std::exception&) {
    // The page of a run that broke shows its last frames.
    write_page(options, simulation, stderr);
    throw;
  }
  return print_end(options, simulation, end);
}

}  // namespace

// A list of options. NOLINTNEXTLINE(readability-function-size)
void add_run(CLI::App& app, Action& action, std::vector<std::string> command_line) {
  auto options = std::make_shared<RunOptions>();
  options->simulation.command = std::move(command_line);
  CLI::App* command = app.add_subcommand("run", "run a scene; results go to out/<scenario>/");
  options->scene.add_to(*command);
  options->scene.add_overlays_to(*command);
  // The options below concern the run, not the scene.
  command->add_option("--out", options->simulation.folder, "directory of the results")
      ->check([](const std::string& text) {
        // An unset shell variable gives an empty name. The default would be another folder than the
        // intended one.
        return text.empty() ? "the folder's name is empty; omit --out to use out/<scenario>" : "";
      });
  command
      ->add_option("--pictures", options->pictures,
                   "video: one file per camera by the program ffmpeg; png: one file per picture; "
                   "without it videos where ffmpeg is found")
      ->check([](const std::string& text) {
        return picture_formats().count(text) > 0 ? "" : "'" + text + "' is not video or png";
      });
  command
      ->add_option("--particles", options->particles,
                   "RATE[,FORMAT]: write the active soil to particles/ this often per simulated "
                   "second, as vtu (default), npz or ply")
      ->check([](const std::string& text) {
        return text.empty() ? "no rate is given; use RATE or RATE,FORMAT, for example 10,npz" : "";
      });
  // Options that need each other are given by pointer: CLI11 does not survive running out of memory
  // while it looks up names.
  CLI::Option* control =
      command->add_option("--control", options->control,
                          "stdio: per control step print one JSON line of outputs "
                          "and read one of inputs, in lock step; requests for maps, "
                          "arrays, particles, pictures and states come between them");
  command
      ->add_option("--control-rate", options->control_rate,
                   "control steps per simulated second (50); the base step divides their period")
      ->check(within(0.001, 1e5))
      ->needs(control);
  CLI::Option* snapshot = command->add_option("--snapshot", options->simulation.snapshot,
                                              "file to save the state to at --snapshot-at");
  CLI::Option* snapshot_at = command
                                 ->add_option("--snapshot-at", options->simulation.snapshot_at,
                                              "simulated time of the snapshot [s]")
                                 ->check(not_negative)
                                 ->needs(snapshot);
  // Either of the two alone is a mistake.
  snapshot->needs(snapshot_at);
  CLI::Option* resume =
      command->add_option("--resume", options->simulation.resume, "snapshot to continue from");
  command
      ->add_flag("--resume-anyway", options->simulation.resume_anyway,
                 "continue even if the scene's parameters differ from the snapshot's; lists the "
                 "differences")
      ->needs(resume);
  command
      ->add_option("--hash-every", options->simulation.hash_every,
                   "simulated seconds between rows of hashes.csv, the hashes of the state and its "
                   "parts")
      ->check(above_zero);
  CLI::Option* publish =
      command->add_option("--publish", options->publish.place,
                          "publish the changing map to other processes: tcp:PORT "
                          "(on 127.0.0.1), tcp:HOST:PORT, or a new folder");
  command->add_option("--publish-rate", options->publish.rate, "updates per simulated second (10)")
      ->check(within(0.001, 1e4))
      ->needs(publish);
  command
      ->add_option("--publish-layers", options->publish.layers, "names separated by commas (all)")
      ->needs(publish);
  command->add_option("--publish-sensors", options->publish_sensors,
                      "send each reading of the sensors to other processes: tcp:PORT (on "
                      "127.0.0.1) or tcp:HOST:PORT");
  command
      ->add_option("--view", options->view,
                   "show the run live in browsers of this machine, on this port of 127.0.0.1 (0: "
                   "any free one); prints the address. Pages can pause, step and command the run")
      ->check(CLI::Range(0, 65535));
  command->add_option("--watch", options->simulation.watch,
                      "MACHINE/LINK: add pose, velocity and angular velocity of this link to the "
                      "outputs; repeatable");
  command->add_flag("--energy", options->simulation.soil_energy,
                    "report the energy account of the soil in the summary; takes up to three times "
                    "as long");
  command->add_flag(
      "--no-report", options->no_report,
      "write neither replay.jsonl nor report.html, the page that shows the run again");
  command->add_flag("--quiet", options->quiet, "print no progress line and no notes");
  command->footer(
      "Example: navvy run trench --set soil.cohesion_pa=8000 --duration 60 --out out/stiff");
  command->callback([options, &action] { action = [options] { return run_scene(*options); }; });
}

}  // namespace navvy::cli
