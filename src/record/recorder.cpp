// SPDX-License-Identifier: Apache-2.0
#include "record/recorder.h"

#include <exception>
#include <functional>
#include <optional>
#include <utility>
#include <vector>

#include "core/error.h"
#include "core/file.h"
#include "core/log.h"
#include "core/stopwatch.h"
#include "record/array_recorder.h"
#include "record/camera_pictures.h"
#include "record/crash_summary.h"
#include "record/hash_log.h"
#include "record/map_recorder.h"
#include "record/particle_recorder.h"
#include "record/path_file.h"
#include "record/replay_recorder.h"
#include "record/run_info.h"
#include "record/sensor_streams.h"
#include "record/telemetry.h"
#include "record/terrain_files.h"
#include "sim/timing.h"

namespace navvy::record {

/// The parts of a recording. Each writes its own files.
struct Recorder::State {
  // All parts refer to the same session.
  State(session::Session& s, Options o, std::unique_ptr<RunFolder> f)
      : session(s),
        options(std::move(o)),
        folder(std::move(f)),
        crash_summary(std::in_place, folder->path("summary.reserve"), folder->path("summary.json")),
        telemetry(s, folder->path("telemetry.csv"), folder->path("telemetry.npy")),
        arrays(s, *folder),
        pictures(s),
        picture_files(*folder, options.picture_format) {
    // A resumed run counts only its own speed.
    status.start_time = s.world().time();
  }

  // Telemetry and arrays are written at checkpoints, pictures and hashes at once.
  session::Session& session;
  Options options;
  std::unique_ptr<RunFolder> folder;
  std::optional<CrashSummary> crash_summary;
  Telemetry telemetry;
  ArrayRecorder arrays;
  CameraPictures pictures;
  PictureFiles picture_files;
  std::unique_ptr<HashLog> hashes;
  std::unique_ptr<MapRecorder> maps;
  std::unique_ptr<ParticleRecorder> particles;
  std::unique_ptr<ReplayRecorder> replay;
  RunStatus status;
  Stopwatch total, since_checkpoint, since_summary;
  std::size_t summary_bytes = 0;  ///< size of the last summary
  bool finished = false;

  std::string path(const std::string& name) { return folder->path(name); }
  /// Returns true if the present step is the nearest to a multiple of the period of `rate` [1/s].
  bool due(double rate) const;
  void sample_when_due();
  void draw_when_due();
  void record_arrays();
  void hash_when_due();
  void map_when_due();
  void write_particles_when_due();
  void replay_when_due();
  void checkpoint(bool force);
  void write_summary(bool with_hash);
  void write_paths();
  /// Writes the rest of every file but the summary; `attempt` runs each part.
  void finish_files(bool failed, const std::function<void(const std::function<void()>&)>& attempt);
  std::string summary(bool with_hash) const { return summary_json(session, status, with_hash); }
  void write_start();
  void write_description();
  void move_out();
};

Recorder::Recorder(session::Session& session, Options options, std::unique_ptr<RunFolder> folder) {
  // Nothing is written before the folder is ready. Problems show before the first step.
  if (!folder) folder = std::make_unique<RunFolder>(options.directory);
  folder->begin();
  state_ = std::make_unique<State>(session, std::move(options), std::move(folder));
  try {
    state_->write_start();
  } catch (const std::exception& error) {
    write_crash_summary("failed", error.what());
    throw;
  }
}

void Recorder::State::write_start() {
  // The summary exists from the start, so that every run has one, whatever happens.
  write_summary(false);
  write_description();
  write_terrain(session.world(), path("terrain_start.tif"));
  // Made after the run or by hand: the next run moves it, too.
  path("report.html");
  if (options.replay) replay = std::make_unique<ReplayRecorder>(session, path("replay.jsonl"));
  // The first row is the state before any step.
  sample_when_due();
  record_arrays();
  draw_when_due();
  if (options.hash_every > 0)
    hashes = std::make_unique<HashLog>(session, path("hashes.csv"), options.hash_every);
  if (!session.world().description().records.empty())
    maps = std::make_unique<MapRecorder>(session, *folder, sensor_streams(session.world()));
  if (options.particles.rate > 0)
    particles = std::make_unique<ParticleRecorder>(session, *folder, options.particles);
  map_when_due();
  write_particles_when_due();
  replay_when_due();
  checkpoint(true);
}

/// Writes what describes the run: its scene, command and version.
void Recorder::State::write_description() {
  if (!options.scene_text.empty()) write_file_atomically(path("scene.sdf"), options.scene_text);
  write_file_atomically(path("run.json"), run_json({kRunFormat, navvy_version(), options.command,
                                                    session.world().description().file,
                                                    session.device_name(), device::kernel_sources(),
                                                    options.schedule, deciding_environment()}));
}

/// Saves what can be saved when the folder was removed or replaced: open files still hold their
/// rows, and the files of the end of a run are made from its state. Always throws then.
void Recorder::State::move_out() {
  if (folder->intact()) return;
  const std::string lost = folder->directory();
  folder->move_out();
  telemetry.move_to(path("telemetry.csv"), path("telemetry.npy"));
  if (replay) replay->move_to(path("replay.jsonl"));
  if (hashes) hashes->move_to(path("hashes.csv"));
  arrays.move_out();
  crash_summary.reset();
  crash_summary.emplace(path("summary.reserve"), path("summary.json"));
  write_description();
  throw FileError(
      "the folder of the results '" + lost +
      "' was removed or replaced while the run wrote to it: summary, telemetry, hashes, "
      "arrays and the final ground are saved in '" +
      folder->directory() + "'; pictures, maps, particles and the ground at the start are lost");
}

Recorder::~Recorder() = default;

bool Recorder::State::due(double rate) const {
  // Depends on the step count alone, so a resumed run records the same steps as the whole run.
  return rate > 0 && sim::sample_due(session.world().steps(), session.world().dt(), rate);
}

/// Writes the planned paths. A run without any has no such file.
void Recorder::State::write_paths() {
  std::string rows;
  for (const session::ProgramReport& report : session.programs())
    rows += record::path_rows(
        session.world().description().machines[static_cast<std::size_t>(report.machine)].name,
        report.paths);
  if (!rows.empty()) write_file_atomically(path("paths.csv"), record::path_header() + "\n" + rows);
}

/// Adds at most one row per step, also for a rate above the step rate.
void Recorder::State::sample_when_due() {
  const bool first = telemetry.rows() == 0;
  if (!first && !due(session.world().description().recording.telemetry_rate)) return;
  const Lap lap(status.record_time);
  telemetry.sample();
}

/// All cameras of one instant share a frame.
void Recorder::State::draw_when_due() {
  if (!options.render) return;
  const sim::World& world = session.world();
  std::vector<const scene::Camera*> cameras;
  for (const scene::Camera& camera : world.description().cameras)
    if (due(camera.rate)) cameras.push_back(&camera);
  // Drawing is timed apart: the real-time factor is that of the simulation.
  const Lap lap(status.render_time);
  pictures.draw(cameras, [&](const scene::Camera& camera, const Pose& X_WC, render::Image image) {
    const std::uint64_t number = sim::sample_number(world.steps(), world.dt(), camera.rate);
    picture_files.write(camera, number, std::move(image));
    if (replay) replay->add_picture(camera.name, number, X_WC);
    ++status.frames;
  });
}

/// Arrays come at the rates of their samplers; the recorder looks in each step for new values.
void Recorder::State::record_arrays() {
  if (session.world().arrays().channels().empty()) return;
  const Lap lap(status.record_time);
  arrays.observe();
}

void Recorder::State::hash_when_due() {
  if (!hashes) return;
  const Lap lap(status.record_time);
  // Costs a pass over the state, so it runs on request only.
  hashes->observe();
}

/// The map recorder knows which of its records are due.
void Recorder::State::map_when_due() {
  if (!maps) return;
  const Lap lap(status.record_time);
  maps->observe();
}

void Recorder::State::write_particles_when_due() {
  if (!particles) return;
  const Lap lap(status.record_time);
  particles->observe();
}

void Recorder::State::replay_when_due() {
  if (!replay) return;
  const Lap lap(status.record_time);
  replay->observe();
}

void Recorder::State::checkpoint(bool force) {
  // Wall time of the simulation only.
  status.wall_time = total.seconds() - status.render_time - status.record_time;
  if (!force && since_checkpoint.seconds() < options.checkpoint) return;
  const Lap lap(status.record_time);
  if (!folder->intact())
    throw FileError("the folder of the results '" + folder->directory() +
                    "' was removed or replaced while the run wrote to it");
  // Checkpoints come at least two seconds apart, except for the last.
  telemetry.checkpoint(force);
  arrays.checkpoint(force);
  if (replay) replay->checkpoint(force);
  // Only the first and the last summary contain the hash, which costs a pass over the state.
  if (force || since_summary.seconds() >= rewrite_period(summary_bytes)) write_summary(force);
  // The interval counts from the end of writing, or a slow disk would be busy all the time.
  since_checkpoint.restart();
}

/// Also updates the text that a crash would write.
void Recorder::State::write_summary(bool with_hash) {
  status.encode_time = picture_files.processor_time();
  const std::string text = summary(with_hash);
  crash_summary->keep(text);
  write_file_atomically(path("summary.json"), text);
  summary_bytes = text.size();
  since_summary.restart();
}

/// Cheap outputs come first: a full disk shows at the cheapest.
void Recorder::observe() {
  state_->sample_when_due();
  state_->record_arrays();
  state_->draw_when_due();
  state_->hash_when_due();
  state_->map_when_due();
  state_->write_particles_when_due();
  state_->replay_when_due();
  state_->checkpoint(false);
}

void Recorder::restart() {
  State& s = *state_;
  const Lap lap(s.status.record_time);
  s.arrays.restart();
  s.picture_files.restart();
  if (s.replay) s.replay->restart();
  if (s.maps) {
    s.maps->restart();
    s.maps->observe();
  }
  if (s.particles) {
    s.particles->restart();
    s.particles->observe();
  }
}

void Recorder::State::finish_files(
    bool failed, const std::function<void(const std::function<void()>&)>& attempt) {
  attempt([&] { move_out(); });
  // The state at the failure, for analysis.
  if (failed) attempt([&] { session.save(path("failed.snapshot")); });
  // Waits for the thread that encodes.
  attempt([&] {
    const Lap lap(status.render_time);
    picture_files.finish();
  });
  status.encode_time = picture_files.processor_time();
  attempt([&] {
    if (hashes) hashes->finish();
  });
  attempt([&] {
    if (maps) maps->finish();
  });
  // The final ground, also of a failed run.
  attempt([&] { write_terrain(session.world(), path("terrain_end.tif")); });
  attempt([&] { telemetry.checkpoint(true); });
  attempt([&] { arrays.checkpoint(true); });
  attempt([&] {
    if (!replay) return;
    replay->finish();
    replay->checkpoint(true);
  });
  attempt([&] { write_paths(); });
}

void Recorder::finish(const std::string& status, const std::string& message) {
  State& s = *state_;
  // A failure while finishing must not write a second, different summary.
  if (s.finished) return;
  s.finished = true;
  s.status.status = status;
  s.status.message = message;
  // Each file is written independently: if one fails, the others are still written, and the
  // summary, which comes last, reports it.
  // The first failure is thrown at the end, after all files had their chance.
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
  s.finish_files(status == "failed", attempt);
  std::string text;
  bool written = false;
  attempt([&] {
    s.status.wall_time = s.total.seconds() - s.status.render_time - s.status.record_time;
    text = s.summary(true);
    write_file_atomically(s.path("summary.json"), text);
    written = true;
  });
  // If the disk takes no new file, the reserved one serves.
  if (!written) {
    try {
      text = s.summary(true);
    } catch (const std::exception&) {
      text.clear();
    }
    if (text.empty() || !s.crash_summary->write(text))
      write_crash_summary("failed", s.status.message.c_str());
  }
  // The cause of a failed run is known already.
  if (first && status != "failed") std::rethrow_exception(first);
}

render::Image Recorder::draw(const std::string& camera) {
  const Lap lap(state_->status.render_time);
  return state_->pictures.draw(camera);
}

std::string Recorder::summary(bool with_hash) const { return state_->summary(with_hash); }
std::string Recorder::folder() const {
  return state_->folder->intact() ? state_->folder->directory() : std::string();
}
const RunStatus& Recorder::status() const { return state_->status; }

double wall_time_left(double simulated, double real_time_factor) {
  // The last step may end a rounding error after the duration; "-0 s left" would be printed then.
  return real_time_factor > 0 && simulated > 0 ? simulated / real_time_factor : 0;
}

}  // namespace navvy::record
