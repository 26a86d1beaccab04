// SPDX-License-Identifier: Apache-2.0
// `navvy run`: a scene from start to results.
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <atomic>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <memory>

#include "cli/commands.h"
#include "cli/control_stdio.h"
#include "cli/exit_code.h"
#include "cli/scene_options.h"
#include "cli/validators.h"
#include "core/file.h"
#include "core/log.h"
#include "core/stopwatch.h"
#include "device/device.h"
#include "record/recorder.h"
#include "sim/session.h"

namespace navvy::cli {
namespace {

std::atomic<bool> interrupted{false};
extern "C" void on_signal(int) { interrupted = true; }

struct RunOptions {
  SceneOptions scene;
  std::string out;
  std::string control;
  double control_rate = 50;
  std::string resume;
  std::string snapshot;
  double snapshot_at = -1;
  double hash_every = 0;
  bool quiet = false;
};

/// One line on a terminal, rewritten twice a second; nothing when stderr is a file or pipe.
class ProgressLine {
 public:
  explicit ProgressLine(bool quiet) : on_(!quiet && isatty(STDERR_FILENO) != 0) {}
  void show(const record::Progress& p) {
    if (!on_ || watch_.seconds() < 0.5) return;
    watch_.restart();
    std::fprintf(stderr,
                 "\r%7.1f / %.0f s  x%.2f real time  %6d particles  cycle %d  %-10s  at most %3.0f s left \033[K",
                 p.time, p.duration, p.real_time_factor, p.particles, p.cycles, p.phase.c_str(), p.remaining);
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

std::string default_out(const scene::World& world) { return "out/" + (world.name.empty() ? "run" : world.name); }

/// Steps until done or interrupted. @throws whatever a step throws, after the recorder has closed as "failed".
int step_to_the_end(const RunOptions& options, sim::Session& session, record::Recorder& recorder) {
  ProgressLine line(options.quiet || !options.control.empty());
  std::unique_ptr<ControlStdio> control;
  if (!options.control.empty())
    control = std::make_unique<ControlStdio>(session, options.control_rate, [] { return interrupted.load(); });
  bool snapshot_due = !options.snapshot.empty();
  try {
    while (!session.done() && !interrupted) {
      if (control && !control->exchange()) break;
      if (snapshot_due && session.world().time() >= options.snapshot_at) {
        session.save(options.snapshot);
        snapshot_due = false;
      }
      session.step();
      recorder.observe();
      line.show(recorder.progress());
    }
  } catch (const std::exception& error) {
    line.end();
    try {
      recorder.finish("failed", error.what());
    } catch (const std::exception& second) {
      log(LogLevel::kError, std::string("results of the failed run are incomplete: ") + second.what());
    }
    throw;
  }
  line.end();
  if (snapshot_due)
    log_warning("no snapshot: the run ended at " + std::to_string(session.world().time()) + " s, before --snapshot-at");
  recorder.finish(interrupted ? "interrupted" : "finished");
  return interrupted ? kInterrupted : kOk;
}

/// A snapshot that cannot be read is bad input, told before the scene is built.
void require_snapshot(const std::string& path) {
  if (path.empty() || (std::filesystem::is_regular_file(path) && std::ifstream(path).is_open())) return;
  throw InputError(Fault{Fault::Severity::kError, "", 0, "--resume", path, "no such snapshot, or it cannot be read",
                         "--snapshot FILE --snapshot-at T writes one; a run that stopped itself leaves failed.snapshot "
                         "among its results"});
}

int run(const RunOptions& options) {
  if (!options.control.empty() && options.control != "stdio")
    throw InputError(Fault{Fault::Severity::kError, "", 0, "--control", options.control, "only 'stdio' is known",
                           "leave it out to let the scene's program drive"});
  require_snapshot(options.resume);
  const scene::World description = options.scene.load();
  device::Device device(options.scene.device);
  if (!options.quiet) log_info("device " + device.info().text());
  record::Options record_options;
  record_options.directory = options.out.empty() ? default_out(description) : options.out;
  record_options.render = description.recording.render;
  record_options.hash_every = options.hash_every;
  sim::Session session(description, device);
  if (!options.resume.empty()) session.load(options.resume);
  record::Recorder recorder(session, record_options);
  if (!options.snapshot.empty()) require_writable(options.snapshot);
  struct sigaction action = {};
  action.sa_handler = on_signal;
  // A read of standard input must end at Ctrl-C, or a silent controller could hold the program for ever.
  action.sa_flags = options.control.empty() ? SA_RESTART : 0;
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
  std::signal(SIGPIPE, SIG_IGN);
  const int code = step_to_the_end(options, session, recorder);
  std::FILE* say = options.control.empty() ? stdout : stderr;
  std::fprintf(say, "results: %s/summary.json\n", record_options.directory.c_str());
  return code;
}

}  // namespace

void add_run(CLI::App& app, Action& action) {
  auto options = std::make_shared<RunOptions>();
  CLI::App* command = app.add_subcommand("run", "run a scene; results go to out/<scenario>/");
  options->scene.add_to(*command);
  command->add_option("--out", options->out, "directory of the results");
  command->add_option("--control", options->control,
                      "stdio: print one JSON line of outputs and read one of inputs per control step, in lock step");
  command->add_option("--control-rate", options->control_rate, "control steps per simulated second")
      ->check(above_zero)
      ->needs("--control");
  command->add_option("--snapshot", options->snapshot, "file to save the state to, at --snapshot-at");
  command->add_option("--snapshot-at", options->snapshot_at, "simulated time of the snapshot [s]")->needs("--snapshot");
  command->get_option("--snapshot")->needs("--snapshot-at");
  command->add_option("--resume", options->resume, "snapshot to go on from");
  command
      ->add_option("--hash-every", options->hash_every,
                   "simulated seconds between rows of hashes.csv: what the state and each part of it hash to")
      ->check(above_zero);
  command->add_flag("--quiet", options->quiet, "no progress line, no notes");
  command->footer("Example: navvy run trench --set soil.cohesion_pa=8000 --duration 60 --out out/stiff");
  command->callback([options, &action] { action = [options] { return run(*options); }; });
}

}  // namespace navvy::cli
