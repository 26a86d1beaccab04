// SPDX-License-Identifier: Apache-2.0
// `navvy run`: a scene from start to results.
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <charconv>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <memory>
#include <optional>

#include "cli/commands.h"
#include "cli/control_stdio.h"
#include "cli/exit_code.h"
#include "cli/scene_options.h"
#include "cli/stop_signals.h"
#include "cli/validators.h"
#include "core/file.h"
#include "core/log.h"
#include "core/sealed.h"
#include "core/stopwatch.h"
#include "device/device.h"
#include "formats/png_file.h"
#include "link/published_map.h"
#include "planner/map_path_planner.h"
#include "record/map_recorder.h"
#include "record/rates_note.h"
#include "record/recorder.h"
#include "record/run_folder.h"
#include "session/session.h"

namespace navvy::cli {
namespace {

using link::PublishedMap;
using link::PublishOptions;
using link::require_publishable;

struct RunOptions {
  SceneOptions scene;
  std::string out;
  std::string control;
  double control_rate = 50;
  std::string resume;
  bool resume_anyway = false;
  std::string snapshot;
  double snapshot_at = -1;
  double hash_every = 0;
  PublishOptions publish;
  std::vector<std::string> watch;  ///< "machine/link"
  bool energy = false;
  bool quiet = false;
  std::vector<std::string> command;  ///< the whole command line, for the run's folder
};

/// One line on a terminal, rewritten twice a second; nothing when stderr is a file or pipe.
class ProgressLine {
 public:
  explicit ProgressLine(bool quiet) : on_(!quiet && isatty(STDERR_FILENO) != 0) {}
  void show(const record::RunProgress& p) {
    // Twice a second: a terminal is slower than a step.
    if (!on_ || watch_.seconds() < 0.5) return;
    watch_.restart();
    // One line, cleared to its end.
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

/// Named by the scene and not by its file: a scene read from a run's folder goes back there.
std::string default_out(const scene::Scene& world) {
  return "out/" + (world.name.empty() ? "run" : world.name);
}

/// "12.5" for people.
std::string short_text(double value) {
  char text[40];
  std::snprintf(text, sizeof text, "%.6g", value);
  return text;
}

/// What a controller may ask of the recorder.
ControlServices services_of(record::Recorder& recorder) {
  ControlServices services;
  services.draw = [&recorder](const std::string& camera) {
    const render::Image image = recorder.draw(camera);
    return Picture{
        image.width, image.height,
        formats::png_bytes(formats::PixelKind::kRgb, image.width, image.height, image.rgb)};
  };
  return services;
}

/// A controller's turn, if there is one. False: it told the run to end.
bool exchange(ControlStdio* control, record::Recorder& recorder, PublishedMap* published) {
  if (control == nullptr) return true;
  const bool go_on = control->exchange();
  // Also where the controller ends right after it: what is written next is of the state as it is
  // now.
  if (control->take_moved()) {
    recorder.restart();
    if (published != nullptr) published->restart();
  }
  return go_on;
}

/// The map of the end. @throws what keeps it from readers, after the recorder has closed as
/// "failed".
void publish_end(PublishedMap* published, record::Recorder& recorder) {
  if (published == nullptr) return;
  try {
    published->finish();
  } catch (const std::exception& error) {
    recorder.finish("failed", error.what());
    throw;
  }
}

/// Also the ground of a run that failed is shown: that of its end, as terrain_end.tif has it.
/// Throws nothing of its own: the failure is what the user reads.
void publish_end_of_failure(PublishedMap* published) {
  if (published == nullptr) return;
  try {
    published->finish();
  } catch (const std::exception& error) {
    log(LogLevel::kError, std::string("the published map is not that of the end: ") + error.what());
  }
}

/// What ends the run before its time: a signal, a controller that has gone; empty: nothing.
std::string interrupted_by(const ControlStdio* control) {
  if (StopSignals::asked()) return StopSignals::name();
  return control != nullptr ? control->gone() : "";
}

/// Writes what a run leaves that nothing failed in; its exit status. `by`: what interrupted it.
int close_run(const RunOptions& options, const session::Session& session,
              record::Recorder& recorder, PublishedMap* published, const std::string& by,
              bool asked_to_end) {
  publish_end(published, recorder);
  const bool complete = session.complete();
  recorder.finish(!by.empty() ? "interrupted" : complete ? "finished" : "incomplete", by);
  if (!by.empty()) {
    // Else its last line would be that of a run that came to its end.
    std::fprintf(options.control.empty() ? stdout : stderr, "interrupted: %s, at %s s\n",
                 by.c_str(), short_text(session.world().time()).c_str());
    return kInterrupted;
  }
  // Whoever gives --duration, or says "end", asks for no more than that: a program that it cuts off
  // is told, and no failure.
  const bool cut_as_asked = (options.scene.duration > 0 || asked_to_end) && !session.fell_short();
  return complete || cut_as_asked ? kOk : kIncomplete;
}

/// Steps until done or interrupted. @throws whatever a step throws, after the recorder has closed
/// as "failed".
int step_to_the_end(const RunOptions& options, session::Session& session,
                    record::Recorder& recorder, StopSignals& signals, PublishedMap* published) {
  ProgressLine line(options.quiet || !options.control.empty());
  // A controller replaces nothing but the inputs that it sends.
  std::unique_ptr<ControlStdio> control;
  // The line of control ends its wait when Ctrl-C comes.
  const ControlServices services = services_of(recorder);
  bool snapshot_due = !options.snapshot.empty(), asked_to_end = false;
  try {
    if (!options.control.empty())
      control = std::make_unique<ControlStdio>(session, options.control_rate, StopSignals::asked,
                                               services);
    // Order within a step: control, snapshot, step, record. A snapshot therefore holds the commands
    // of its step's start.
    while (!session.done() && !StopSignals::asked()) {
      asked_to_end = !exchange(control.get(), recorder, published);
      if (asked_to_end) break;
      if (snapshot_due && session.world().time() >= options.snapshot_at) {
        session.save(options.snapshot);
        snapshot_due = false;
      }
      // All that a step changes is recorded before the next one.
      session.step();
      recorder.observe();
      if (published != nullptr) published->observe();
      line.show(recorder.progress());
    }
    // The state of the end is one, too.
    if (snapshot_due &&
        session.world().time() >= options.snapshot_at - 0.5 * session.world().dt()) {
      session.save(options.snapshot);
      snapshot_due = false;
    }
  } catch (const std::exception& error) {
    // The first cause is what the user reads; a second one in closing the files is only logged by
    // the recorder.
    line.end();
    signals.obeyed();
    recorder.finish("failed", error.what());
    publish_end_of_failure(published);
    // The exit status says which kind of failure it was.
    throw;
  }
  line.end();
  // Asked for and not written: that must not go unnoticed.
  if (snapshot_due)
    log(LogLevel::kError, "no snapshot: the run ended at " + short_text(session.world().time()) +
                              " s, before --snapshot-at " + short_text(options.snapshot_at));
  // From here on nobody hurries: the files are closed in their order.
  const std::string by = interrupted_by(control.get());
  signals.obeyed();
  const int code = close_run(options, session, recorder, published, by, asked_to_end);
  return snapshot_due && code != kInterrupted ? kFile : code;
}

/// The programs that did not come to their end, one a line: what a user must not miss.
void print_programs(std::FILE* say, const session::Session& session) {
  for (const session::ProgramReport& report : session.programs()) {
    if (report.by_inputs() || report.last().state == control::StepState::kDone) continue;
    const std::string& name =
        session.world().description().machines[static_cast<std::size_t>(report.machine)].name;
    std::fprintf(say, "incomplete: %s\n",
                 session::told(report, name, "the controller ended the run").c_str());
  }
}

/// A snapshot that cannot be read is bad input, told before the scene is built.
void require_snapshot(const std::string& path) {
  if (path.empty()) return;
  try {
    require_regular(path);
  } catch (const FileError& error) {
    throw InputError(Fault{Fault::Severity::kError, "", 0, "--resume", path, error.what(),
                           "name a snapshot's file"});
  }
  if (std::ifstream(path).is_open()) return;
  // Where snapshots come from is what a user asks next.
  throw InputError(Fault{Fault::Severity::kError, "", 0, "--resume", path,
                         "no such snapshot, or it cannot be read",
                         "--snapshot FILE --snapshot-at T writes one; a run that stopped itself "
                         "leaves failed.snapshot "
                         "among its results"});
}

/// Nobody's file is lost to a slip: what is there and holds something must be a snapshot, and what
/// the run writes itself stays its own.
void require_place_of_snapshot(const std::string& path, const std::string& out) {
  if (path.empty()) return;
  const auto refuse = [&](const char* rule, const char* remedy) {
    throw InputError(Fault{Fault::Severity::kError, "", 0, "--snapshot", path, rule, remedy});
  };
  std::error_code code;
  if (!is_sealed(path) && std::filesystem::is_regular_file(path, code) &&
      std::filesystem::file_size(path, code) > 0)
    refuse("is there and is no snapshot, so it stays", "name a new file, or remove this one");
  const auto place = [&code](const std::filesystem::path& one) {
    return std::filesystem::weakly_canonical(std::filesystem::absolute(one, code), code);
  };
  const std::filesystem::path in = place(path);
  if (in.parent_path() == place(out) && record::RunFolder::writes(in.filename().string()))
    refuse("is a name that the run gives to a file of its own",
           "choose another name, or another folder");
}

/// A snapshot that the run does not come to, or one with nothing behind it, is a slip: told before
/// the first step.
void require_times(const RunOptions& options, const session::Session& session) {
  const double now = session.world().time(), end = session.world().description().recording.duration;
  if (!options.snapshot.empty() && options.snapshot_at > end)
    throw InputError(Fault{Fault::Severity::kError, "", 0, "--snapshot-at",
                           short_text(options.snapshot_at),
                           "the run lasts " + short_text(end) + " s at most",
                           "choose an earlier moment, or a longer --duration"});
  if (!options.resume.empty() && session.done())
    throw InputError(Fault{Fault::Severity::kError, "", 0, "--resume", options.resume,
                           "it was taken at " + short_text(now) +
                               " s, and there is nothing left to run: the duration is " +
                               short_text(end) + " s, or all programs have ended",
                           "choose a longer --duration, or an earlier snapshot"});
}

int run(const RunOptions& options) {
  if (!options.control.empty() && options.control != "stdio")
    throw InputError(Fault{Fault::Severity::kError, "", 0, "--control", options.control,
                           "only 'stdio' is known",
                           "leave it out to let the scene's program drive"});
  // Before anything that may take long, such as a driver that compiles.
  StopSignals signals;
  // Cheap questions first: everything that can be refused before the scene is built.
  require_snapshot(options.resume);
  require_publishable(options.publish);
  record::Options record_options;
  // The rate goes into the scene, which is written beside the results: base steps follow from it.
  SceneOptions scene = options.scene;
  if (!options.control.empty()) {
    char rate[40];
    *std::to_chars(rate, rate + sizeof rate - 1, options.control_rate).ptr = '\0';
    scene.set.push_back(std::string("solver.control_rate_hz=") + rate);
  }
  const scene::Scene description = scene.load(&record_options.scene_text);
  if (std::vector<Fault> faults = record::check_records(description); !faults.empty())
    throw InputError(std::move(faults));
  record_options.directory = options.out.empty() ? default_out(description) : options.out;
  require_place_of_snapshot(options.snapshot, record_options.directory);
  // Taken before minutes are spent, emptied when the run begins.
  auto folder = std::make_unique<record::RunFolder>(
      record_options.directory,
      std::vector<std::string>{options.resume, description.file, description.ground.file,
                               description.design.file});
  // The scene is sound from here on; a device may still be missing.
  device::Device device(options.scene.device);
  // Said before the run: the first thing to look at when it is slow.
  if (!options.quiet) log_info("device " + device.info().text());
  record_options.command = options.command;
  record_options.render = description.recording.render;
  record_options.hash_every = options.hash_every;
  // The session builds the world; from here on errors leave a folder behind.
  session::Session session(description, device, planner::path_planners());
  // Before the recorder, which counts its frames from the time it finds.
  if (!options.resume.empty()) session.load(options.resume, options.resume_anyway);
  require_times(options, session);
  for (const std::string& link : options.watch) session.watch(link);
  if (options.energy) session.keep_soil_energy();
  // What comes out other than asked is said before the first step.
  const std::string rates =
      record::rates_note(session.world(), options.control.empty() ? 0 : options.control_rate);
  if (!options.quiet && !rates.empty()) log_info(rates);
  // Hours must not end at a path that cannot be written.
  if (!options.snapshot.empty()) require_writable(options.snapshot);
  record::Recorder recorder(session, record_options, std::move(folder));
  std::optional<PublishedMap> published;
  try {
    if (!options.publish.place.empty()) published.emplace(options.publish, session);
  } catch (const std::exception& error) {
    // The port was free a moment ago.
    recorder.finish("failed", error.what());
    throw;
  }
  const int code =
      step_to_the_end(options, session, recorder, signals, published ? &*published : nullptr);
  // Standard output belongs to the controller when there is one.
  std::FILE* say = options.control.empty() ? stdout : stderr;
  if (code != kInterrupted) print_programs(say, session);
  std::fprintf(say, "results: %s/summary.json\n", record_options.directory.c_str());
  return code;
}

}  // namespace

void add_run(CLI::App& app, Action& action, std::vector<std::string> command_line) {
  auto options = std::make_shared<RunOptions>();
  options->command = std::move(command_line);
  CLI::App* command = app.add_subcommand("run", "run a scene; results go to out/<scenario>/");
  options->scene.add_to(*command);
  // What follows leaves the scene alone and goes into the run.
  command->add_option("--out", options->out, "directory of the results")
      ->check([](const std::string& text) {
        // What an unset variable of a shell leaves; the default would be another folder than the
        // one that was meant.
        return text.empty() ? "the folder's name is empty; leave --out away for out/<scenario>"
                            : "";
      });
  // Options that need each other are named by pointer: where the library looks up their names,
  // memory that ends is the end of the program.
  CLI::Option* control = command->add_option("--control", options->control,
                                             "stdio: print one JSON line of outputs and read one "
                                             "of inputs per control step, in lock step");
  command
      ->add_option("--control-rate", options->control_rate,
                   "control steps per simulated second (50); the base step divides their period")
      ->check(CLI::Range(0.001, 1e5))
      ->needs(control);
  CLI::Option* snapshot = command->add_option("--snapshot", options->snapshot,
                                              "file to save the state to, at --snapshot-at");
  CLI::Option* snapshot_at =
      command
          ->add_option("--snapshot-at", options->snapshot_at, "simulated time of the snapshot [s]")
          ->check(not_negative)
          ->needs(snapshot);
  // Either of the two alone is a slip.
  snapshot->needs(snapshot_at);
  CLI::Option* resume = command->add_option("--resume", options->resume, "snapshot to go on from");
  command
      ->add_flag("--resume-anyway", options->resume_anyway,
                 "go on although the scene has other parameters than the snapshot's; says which")
      ->needs(resume);
  command
      ->add_option("--hash-every", options->hash_every,
                   "simulated seconds between rows of hashes.csv: what the state and each part of "
                   "it hash to")
      ->check(above_zero);
  CLI::Option* publish = command->add_option("--publish", options->publish.place,
                                             "the map as it changes, for other processes: tcp:PORT "
                                             "(on 127.0.0.1), tcp:HOST:PORT, or a new folder");
  command->add_option("--publish-rate", options->publish.rate, "updates per simulated second (10)")
      ->check(CLI::Range(0.001, 1e4))
      ->needs(publish);
  command
      ->add_option("--publish-layers", options->publish.layers, "names separated by commas (all)")
      ->needs(publish);
  command->add_option("--watch", options->watch,
                      "MACHINE/LINK: pose, velocity and angular velocity of this link among the "
                      "outputs; may be repeated");
  command->add_flag("--energy", options->energy,
                    "also tell in the summary where the soil's energy came from and went; takes up "
                    "to three times as long");
  command->add_flag("--quiet", options->quiet, "no progress line, no notes");
  command->footer(
      "Example: navvy run trench --set soil.cohesion_pa=8000 --duration 60 --out out/stiff");
  command->callback([options, &action] { action = [options] { return run(*options); }; });
}

}  // namespace navvy::cli
