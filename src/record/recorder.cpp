// SPDX-License-Identifier: Apache-2.0
#include "record/recorder.h"

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <utility>
#include <vector>

#include "core/error.h"
#include "core/file.h"
#include "core/stopwatch.h"
#include "record/hash_log.h"
#include "record/telemetry.h"
#include "record/terrain_files.h"
#include "render/renderer.h"
#include "sim/frame_builder.h"

namespace navvy::record {
namespace fs = std::filesystem;
namespace {

/// How many whole periods of `rate` [Hz] have passed by `time` (with a hair for rounding of time = steps x dt).
std::uint64_t count_at(double time, double rate) { return static_cast<std::uint64_t>(std::floor(time * rate + 1e-9)); }

}  // namespace

struct Recorder::State {
  State(sim::Session& s, Options o)
      : session(s), options(std::move(o)), telemetry(s, options.directory + "/telemetry.csv"), frames(s.world()) {
    // A resumed run goes on in its numbers and counts its own speed only.
    status.start_time = s.world().time();
    for (const scene::Camera& camera : s.world().description().cameras)
      next_frame.push_back(count_at(status.start_time, camera.rate));
    next_sample = count_at(status.start_time, s.world().description().recording.telemetry_rate);
  }

  sim::Session& session;
  Options options;
  Telemetry telemetry;
  sim::FrameBuilder frames;
  std::unique_ptr<render::Renderer> renderer;
  std::unique_ptr<HashLog> hashes;
  std::vector<std::uint64_t> next_frame;  ///< per camera, counts frames
  std::uint64_t next_sample = 0;
  RunStatus status;
  Stopwatch total, since_checkpoint;
  bool finished = false;

  std::string path(const std::string& name) const { return options.directory + "/" + name; }
  void sample_when_due();
  void draw_when_due();
  void hash_when_due();
  void checkpoint(bool force);
};

namespace {

/// True when `count / rate` has been reached by `time` (with a hair for rounding of time = steps x dt).
bool due(double time, std::uint64_t count, double rate) {
  return rate > 0 && time * rate >= static_cast<double>(count) - 1e-9;
}

/// Without the slash that a shell's completion leaves at the end: beside it the earlier results go.
std::string clean(const std::string& directory) {
  const fs::path path = fs::path(directory).lexically_normal();
  return (path.has_filename() ? path : path.parent_path()).string();
}

void make_directory(const std::string& directory) {
  std::error_code code;
  if (fs::exists(directory + "/summary.json", code)) {
    fs::remove_all(directory + ".previous", code);
    fs::rename(directory, directory + ".previous", code);
    if (code) throw FileError("cannot move earlier results '" + directory + "' aside: " + code.message());
  }
  fs::create_directories(directory + "/frames", code);
  if (code) throw FileError("cannot create '" + directory + "': " + code.message());
}

}  // namespace

Recorder::Recorder(sim::Session& session, Options options) {
  options.directory = clean(options.directory);
  make_directory(options.directory);
  state_ = std::make_unique<State>(session, std::move(options));
  State& s = *state_;
  write_terrain(session.world(), s.path("terrain_start.tif"));
  s.sample_when_due();
  if (s.options.render) s.renderer = std::make_unique<render::Renderer>();
  s.draw_when_due();
  if (s.options.hash_every > 0)
    s.hashes = std::make_unique<HashLog>(session, s.path("hashes.csv"), s.options.hash_every);
  s.checkpoint(true);
}

Recorder::~Recorder() = default;

void Recorder::State::sample_when_due() {
  const double rate = session.world().description().recording.telemetry_rate;
  const double time = session.world().time();
  if (!due(time, next_sample, rate)) return;
  const Lap lap(status.record_time);
  telemetry.sample();
  next_sample = count_at(time, rate) + 1;
}

void Recorder::State::draw_when_due() {
  if (!renderer) return;
  const auto& cameras = session.world().description().cameras;
  const double time = session.world().time();
  const scene::Frame* frame = nullptr;
  for (std::size_t i = 0; i < cameras.size(); ++i) {
    if (!due(time, next_frame[i], cameras[i].rate)) continue;
    const Lap lap(status.render_time);
    if (frame == nullptr) frame = &frames.build();
    const render::Image image = renderer->render(*frame, frames.camera(cameras[i]));
    char name[32];
    std::snprintf(name, sizeof name, "_%05llu.png", static_cast<unsigned long long>(next_frame[i]));
    render::write_png(path("frames/" + cameras[i].name + name), image);
    next_frame[i] = count_at(time, cameras[i].rate) + 1;
    ++status.frames;
  }
}

void Recorder::State::hash_when_due() {
  if (!hashes) return;
  const Lap lap(status.record_time);
  hashes->observe();
}

void Recorder::State::checkpoint(bool force) {
  status.wall_time = total.seconds() - status.render_time - status.record_time;
  if (!force && since_checkpoint.seconds() < options.checkpoint) return;
  const Lap lap(status.record_time);
  telemetry.checkpoint(force);
  // The hash of a running state costs a pass over everything: only the forced ones pay it.
  write_file_atomically(path("summary.json"), summary_json(session, status, force));
  since_checkpoint.restart();
}

void Recorder::observe() {
  state_->sample_when_due();
  state_->draw_when_due();
  state_->hash_when_due();
  state_->checkpoint(false);
}

void Recorder::finish(const std::string& status, const std::string& message) {
  State& s = *state_;
  if (s.finished) return;
  s.finished = true;
  s.status.status = status;
  s.status.message = message;
  if (status == "failed") {
    StateWriter writer;
    s.session.save(writer);
    write_file_atomically(s.path("failed.snapshot"), writer.bytes());
  }
  if (s.hashes) s.hashes->finish();
  write_terrain(s.session.world(), s.path("terrain_end.tif"));
  s.checkpoint(true);
}

Progress Recorder::progress() const {
  const State& s = *state_;
  const sim::World& world = s.session.world();
  Progress out;
  out.time = world.time();
  out.duration = world.description().recording.duration;
  const double spent = s.total.seconds();
  out.real_time_factor = spent > 0 ? (out.time - s.status.start_time) / spent : 0;
  out.remaining = out.real_time_factor > 0 ? (out.duration - out.time) / out.real_time_factor : 0;
  out.particles = world.soil().stats().particles;
  out.cycles = static_cast<int>(s.session.cycles().size());
  out.frames = s.status.frames;
  out.phase = world.description().machines.empty() ? "" : s.session.phase(0);
  return out;
}

}  // namespace navvy::record
