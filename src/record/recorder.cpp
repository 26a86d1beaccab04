// SPDX-License-Identifier: Apache-2.0
#include "record/recorder.h"

#include <cstdio>
#include <exception>
#include <utility>
#include <vector>

#include "core/error.h"
#include "core/file.h"
#include "core/log.h"
#include "core/stopwatch.h"
#include "record/crash_summary.h"
#include "record/hash_log.h"
#include "record/map_recorder.h"
#include "record/path_file.h"
#include "record/run_info.h"
#include "record/telemetry.h"
#include "record/terrain_files.h"
#include "render/renderer.h"
#include "sim/frame_builder.h"
#include "sim/timing.h"

namespace navvy::record {

struct Recorder::State {
  // Telemetry and frames look at the same session; neither keeps more than a reference.
  State(session::Session& s, Options o, std::unique_ptr<RunFolder> f)
      : session(s),
        options(std::move(o)),
        folder(std::move(f)),
        crash_summary(folder->path("summary.reserve"), folder->path("summary.json")),
        telemetry(s, folder->path("telemetry.csv")),
        frames(s.world()) {
    // A resumed run goes on in its numbers and counts its own speed only.
    status.start_time = s.world().time();
  }

  // Telemetry is written at checkpoints, pictures and hashes at once.
  session::Session& session;
  Options options;
  std::unique_ptr<RunFolder> folder;
  CrashSummary crash_summary;
  Telemetry telemetry;
  sim::FrameBuilder frames;
  // Of frames; without those, of pictures that somebody asks for
  std::unique_ptr<render::Renderer> renderer, drawer;
  std::unique_ptr<HashLog> hashes;
  std::unique_ptr<MapRecorder> maps;
  RunStatus status;
  Stopwatch total, since_checkpoint, since_summary;
  std::size_t summary_bytes = 0;  // of the last one
  bool finished = false;

  std::string path(const std::string& name) { return folder->path(name); }
  /// Whether the present step is the nearest to a period of `rate` [1/s].
  bool due(double rate) const;
  void sample_when_due();
  void draw_when_due();
  void hash_when_due();
  void map_when_due();
  void checkpoint(bool force);
  void write_summary(bool with_hash);
  void write_paths();
  std::string summary(bool with_hash) const { return summary_json(session, status, with_hash); }
  void write_start();
};

Recorder::Recorder(session::Session& session, Options options, std::unique_ptr<RunFolder> folder) {
  // Nothing is written before the folder stands; what cannot be made is told before the first step.
  if (!folder) folder = std::make_unique<RunFolder>(options.directory);
  folder->begin();
  // Telemetry and frames are made with their paths in the new folder.
  state_ = std::make_unique<State>(session, std::move(options), std::move(folder));
  try {
    state_->write_start();
  } catch (const std::exception& error) {
    write_crash_summary("failed", error.what());
    throw;
  }
}

void Recorder::State::write_start() {
  // A summary from the start on: whatever becomes of the run, it has one, and from here on one can
  // be left that says how it ended.
  write_summary(false);
  // What it was comes next.
  const scene::Scene& scene = session.world().description();
  if (!options.scene_text.empty()) write_file_atomically(path("scene.sdf"), options.scene_text);
  write_file_atomically(path("run.json"), run_json({kRunFormat, navvy_version(), options.command,
                                                    scene.file, session.device_name()}));
  write_terrain(session.world(), path("terrain_start.tif"));
  // The first row is the state before any step.
  sample_when_due();
  // The renderer takes a graphics context, which runs without pictures do not need.
  if (options.render) renderer = std::make_unique<render::Renderer>();
  draw_when_due();
  if (options.hash_every > 0)
    hashes = std::make_unique<HashLog>(session, path("hashes.csv"), options.hash_every);
  if (!scene.records.empty()) maps = std::make_unique<MapRecorder>(session, *folder);
  map_when_due();
  checkpoint(true);
}

Recorder::~Recorder() = default;

bool Recorder::State::due(double rate) const {
  // By the step's number, counted from time zero: a resumed run records the steps that the whole
  // one would.
  return rate > 0 && sim::sample_due(session.world().steps(), session.world().dt(), rate);
}

/// A run in which nobody planned leaves no such file.
void Recorder::State::write_paths() {
  std::string rows;
  for (const session::ProgramReport& report : session.programs())
    rows += record::path_rows(
        session.world().description().machines[static_cast<std::size_t>(report.machine)].name,
        report.paths);
  if (!rows.empty()) write_file_atomically(path("paths.csv"), record::path_header() + "\n" + rows);
}

/// At most one row a step: a rate above the step's gives every step.
void Recorder::State::sample_when_due() {
  const bool first = telemetry.rows() == 0;
  if (!first && !due(session.world().description().recording.telemetry_rate)) return;
  const Lap lap(status.record_time);
  telemetry.sample();
}

void Recorder::State::draw_when_due() {
  // One frame for all cameras of this instant: filling it costs more than a view of it.
  if (!renderer) return;
  const auto& cameras = session.world().description().cameras;
  const sim::World& world = session.world();
  const scene::Frame* frame = nullptr;
  for (const scene::Camera& camera : cameras) {
    if (!due(camera.rate)) continue;
    // Drawing is counted apart: the real-time factor is the simulation's.
    const Lap lap(status.render_time);
    if (frame == nullptr) frame = &frames.build();
    const render::Image image = renderer->render(*frame, frames.camera(camera));
    // The number of a picture tells its time: name_N.png is N periods from the start.
    char name[32];
    const std::uint64_t number = sim::sample_number(world.steps(), world.dt(), camera.rate);
    std::snprintf(name, sizeof name, "_%05llu.png", static_cast<unsigned long long>(number));
    render::write_png(path("frames/" + camera.name + name), image);
    ++status.frames;
  }
}

void Recorder::State::hash_when_due() {
  if (!hashes) return;
  const Lap lap(status.record_time);
  // A pass over everything, so only when asked for.
  hashes->observe();
}

void Recorder::State::map_when_due() {
  if (!maps) return;
  const Lap lap(status.record_time);
  maps->observe();
}

void Recorder::State::checkpoint(bool force) {
  // Wall time of the simulation alone.
  status.wall_time = total.seconds() - status.render_time - status.record_time;
  if (!force && since_checkpoint.seconds() < options.checkpoint) return;
  const Lap lap(status.record_time);
  // At most every other second unless it is the last.
  telemetry.checkpoint(force);
  // The hash of a running state costs a pass over everything: only the forced ones pay it.
  if (force || since_summary.seconds() >= rewrite_period(summary_bytes)) write_summary(force);
  // Counted from the end of the writing, or a slow disk would do nothing else.
  since_checkpoint.restart();
}

/// Kept ready as well, for whoever has to leave it in a hurry.
void Recorder::State::write_summary(bool with_hash) {
  const std::string text = summary(with_hash);
  crash_summary.keep(text);
  write_file_atomically(path("summary.json"), text);
  summary_bytes = text.size();
  since_summary.restart();
}

/// In the order of cost: a full disk is noticed at the cheapest.
void Recorder::observe() {
  state_->sample_when_due();
  state_->draw_when_due();
  state_->hash_when_due();
  state_->map_when_due();
  state_->checkpoint(false);
}

void Recorder::restart() {
  State& s = *state_;
  if (!s.maps) return;
  const Lap lap(s.status.record_time);
  s.maps->restart();
  s.maps->observe();
}

void Recorder::finish(const std::string& status, const std::string& message) {
  State& s = *state_;
  // Failing while finishing must not write a second, half different summary.
  if (s.finished) return;
  s.finished = true;
  s.status.status = status;
  s.status.message = message;
  // Each file for itself: one that the disk refuses keeps none of the others from being written,
  // and the summary, which comes last, tells of it.
  std::exception_ptr first;
  const auto attempt = [&](const auto& write) {
    try {
      write();
    } catch (const std::exception& error) {
      // The first cause is what the user reads.
      if (s.status.status == "failed")
        log(LogLevel::kError,
            std::string("results of the failed run are incomplete: ") + error.what());
      else
        s.status.message = error.what();
      s.status.status = "failed";
      if (!first) first = std::current_exception();
    }
  };
  // The state of the fault, to be looked at or gone on from.
  if (status == "failed") attempt([&] { s.session.save(s.path("failed.snapshot")); });
  attempt([&] {
    if (s.hashes) s.hashes->finish();
  });
  attempt([&] {
    if (s.maps) s.maps->finish();
  });
  // The end of the ground, also of a run that failed: it shows where.
  attempt([&] { write_terrain(s.session.world(), s.path("terrain_end.tif")); });
  attempt([&] { s.telemetry.checkpoint(true); });
  attempt([&] { s.write_paths(); });
  std::string text;
  bool written = false;
  attempt([&] {
    s.status.wall_time = s.total.seconds() - s.status.render_time - s.status.record_time;
    text = s.summary(true);
    write_file_atomically(s.path("summary.json"), text);
    written = true;
  });
  // The disk takes no new file: the room that was taken at the start serves.
  if (!written) {
    try {
      text = s.summary(true);
    } catch (const std::exception&) {
      text.clear();
    }
    if (text.empty() || !s.crash_summary.write(text))
      write_crash_summary("failed", s.status.message.c_str());
  }
  // A failed run has told its cause already.
  if (first && status != "failed") std::rethrow_exception(first);
}

render::Image Recorder::draw(const std::string& camera) {
  State& s = *state_;
  // One renderer a process: that of the frames serves, or is made for this.
  if (!s.renderer && !s.drawer) s.drawer = std::make_unique<render::Renderer>();
  for (const scene::Camera& each : s.session.world().description().cameras)
    if (each.name == camera) {
      const Lap lap(s.status.render_time);
      return (s.renderer ? *s.renderer : *s.drawer).render(s.frames.build(), s.frames.camera(each));
    }
  throw InputError(Fault{Fault::Severity::kError, "", 0, "camera", camera,
                         "no camera of this name in the scene", ""});
}

double wall_time_left(double simulated, double real_time_factor) {
  // The last step may end a rounding error after the duration; "-0 s left" would be printed then.
  return real_time_factor > 0 && simulated > 0 ? simulated / real_time_factor : 0;
}

RunProgress Recorder::progress() const {
  const State& s = *state_;
  const sim::World& world = s.session.world();
  RunProgress out;
  out.time = world.time();
  out.duration = world.description().recording.duration;
  // What a resumed run had done before does not count as its own speed.
  const double spent = s.total.seconds();
  out.real_time_factor = spent > 0 ? (out.time - s.status.start_time) / spent : 0;
  out.remaining = wall_time_left(out.duration - out.time, out.real_time_factor);
  out.particles = world.soil().counts().particles;
  out.cycles = static_cast<int>(s.session.cycles().size());
  out.frames = s.status.frames;
  out.phase = world.description().machines.empty() ? "" : s.session.phase(0);
  return out;
}

}  // namespace navvy::record
