// SPDX-License-Identifier: Apache-2.0
#include "run/simulation.h"

#include <algorithm>
#include <utility>

#include "core/error.h"
#include "core/file.h"
#include "core/log.h"
#include "core/saved_state.h"
#include "core/stopwatch.h"
#include "device/device.h"
#include "device/source.h"
#include "earthwork/pit_planner.h"
#include "heightfield/change_follower.h"
#include "planner/map_path_planner.h"
#include "record/camera_pictures.h"
#include "record/map_recorder.h"
#include "record/particle_recorder.h"
#include "record/rates_note.h"
#include "record/recorder.h"
#include "record/run_folder.h"
#include "record/score.h"
#include "record/summary.h"
#include "run/start_checks.h"
#include "sensor/make_sensors.h"
#include "sim/soil_schedule.h"
#include "sim/world_terrain.h"

namespace navvy::run {
namespace {

/// Returns the scene with the values of the options. Samplers, recorder and the summary read them
/// from the scene, so there is one place for each value.
scene::Scene with_options(scene::Scene scene, const SimulationOptions& options) {
  scene::Recording& recording = scene.recording;
  recording.duration = options.duration.value_or(recording.duration);
  recording.telemetry_rate = options.telemetry_rate.value_or(recording.telemetry_rate);
  recording.render = options.pictures.value_or(recording.render);
  scene.solver.control_rate = options.control_rate.value_or(scene.solver.control_rate);
  return scene;
}

/// Gives a scene another seed. Hills without a seed of their own got the scene's seed when they
/// were read; they are recognised by it and follow the change.
void reseed(scene::Scene& scene, std::uint64_t seed) {
  for (scene::GroundFeature& feature : scene.ground.features)
    if (feature.seed == scene.seed) feature.seed = seed;
  scene.seed = seed;
}

/// Returns the goals of the scene that the run misses, as a text; empty if it meets them all.
std::string missed_goals(const session::Session& session) {
  const scene::Goals& goals = session.world().description().goals;
  std::string out;
  // The score costs a pass over the particles.
  if (!goals.any()) return out;
  for (const record::GoalResult& one : record::judge(record::measure_score(session), goals))
    if (!one.met) out += (out.empty() ? "missed goal: " : "; ") + one.text();
  return out;
}

}  // namespace

// Members are destroyed in reverse order: recorder and pictures refer to the session, and the
// session to the device.
struct Simulation::State {
  explicit State(SimulationOptions o) : options(std::move(o)) {}

  SimulationOptions options;
  std::shared_ptr<device::Device> device;
  std::unique_ptr<session::Session> session;
  std::unique_ptr<record::Recorder> recorder;        ///< null without a folder, and after the end
  std::unique_ptr<record::CameraPictures> pictures;  ///< for `image` where there is no recorder
  std::vector<RunObserver*> observers;
  std::vector<char> start;  ///< the state that `reset` returns to
  heightfield::ChangeFollower follower;
  record::RunStatus status;  ///< of a run without a folder
  Stopwatch total;
  std::uint64_t replacements = 0;
  std::string results;        ///< folder of the results after the end; empty if it was lost
  bool replaced = false;      ///< since the recorder and the observers were informed
  bool snapshot_due = false;  ///< SimulationOptions::snapshot is still to be written

  const sim::World& world() const { return session->world(); }
  std::unique_ptr<session::Session> make_session(scene::Scene scene) const;
  void start_recording(std::unique_ptr<record::RunFolder> folder);
  void step();
  void inform();
  void save_due_snapshot(double slack);
  void close();
  template <class Load>
  void replace(const Load& load);
  RunEnd end_now(bool requested, const std::string& interrupted_by) const;
  std::string message_of(const RunEnd& end) const;
  RunEnd finish(RunEnd end);
  void fail(const std::string& cause) noexcept;
};

/// Builds a session. Samplers are added before any state is loaded, as a state contains theirs.
std::unique_ptr<session::Session> Simulation::State::make_session(scene::Scene scene) const {
  auto out = std::make_unique<session::Session>(
      std::move(scene), *device,
      control::Planners{planner::path_planners(), earthwork::job_planners(), options.read_program},
      options.make_engine);
  for (std::unique_ptr<sim::Sampler>& one : sensor::make_sensors(out->world()))
    out->add(std::move(one));
  if (options.set_up) options.set_up(*out);
  return out;
}

Simulation::Simulation(scene::Scene scene, SimulationOptions options)
    : state_(std::make_unique<State>(std::move(options))) {
  State& s = *state_;
  const auto note = [&](const std::string& text) {
    if (s.options.note && !text.empty()) s.options.note(text);
  };
  // Cheap checks come first: all that can be refused before the world is built.
  check_resume(s.options.resume);
  scene = with_options(std::move(scene), s.options);
  if (std::vector<Fault> faults = record::check_records(scene); !faults.empty())
    throw InputError(std::move(faults));
  record::check_particles(s.options.particles);
  check_snapshot(s.options.snapshot, s.options.folder);
  // The folder is locked before minutes are spent, and emptied when the recording begins.
  std::unique_ptr<record::RunFolder> folder;
  if (!s.options.folder.empty())
    folder = std::make_unique<record::RunFolder>(
        s.options.folder, std::vector<std::string>{s.options.resume, scene.file, scene.ground.file,
                                                   scene.design.file});
  // A missing device or a faulty program may end the construction from this line on.
  s.device = s.options.shared_device ? s.options.shared_device
                                     : std::make_shared<device::Device>(s.options.device);
  note("device " + s.device->info().text());
  const device::KernelSources kernels = device::kernel_sources();
  if (!kernels.changed.empty()) note(changed_kernels_note(kernels));
  s.session = s.make_session(std::move(scene));
  // Before the recorder, which counts its pictures from the time it finds.
  if (!s.options.resume.empty()) s.session->load(s.options.resume, s.options.resume_anyway);
  check_times(s.options, *s.session);
  for (const std::string& link : s.options.watch) s.session->watch(link);
  if (s.options.soil_energy) s.session->keep_soil_energy();
  note(record::rates_note(s.world(), s.options.control_rate.value_or(0), s.options.particles.rate));
  // A run of hours must not end at a path that cannot be written.
  s.snapshot_due = !s.options.snapshot.empty();
  if (s.snapshot_due) require_writable(s.options.snapshot);
  // The state that `reset` returns to: some MiB for a million particles, little for untouched
  // ground.
  s.start = saved(*s.session);
  s.status.start_time = s.world().time();
  // The recording begins last, so that a refused option leaves the earlier results in place.
  if (folder) s.start_recording(std::move(folder));
  s.total.restart();
}

/// Hands the options of the output to a recorder.
void Simulation::State::start_recording(std::unique_ptr<record::RunFolder> folder) {
  record::Options out;
  out.directory = folder->directory();
  out.render = world().description().recording.render;
  out.picture_format = options.picture_format;
  out.replay = options.replay;
  out.hash_every = options.hash_every;
  out.particles = options.particles;
  out.scene_text = options.scene_text;
  out.command = options.command;
  out.schedule = sim::soil_schedule(*device);
  recorder = std::make_unique<record::Recorder>(*session, out, std::move(folder));
}

Simulation::~Simulation() {
  if (!state_->recorder) return;
  try {
    finish();
  } catch (const std::exception& error) {
    log(LogLevel::kError, error.what());
  }
}

/// Informs the recorder and the observers of a replaced state. This happens before the next step,
/// so that several replacements between two steps count as one.
void Simulation::State::inform() {
  if (!std::exchange(replaced, false)) return;
  if (recorder) recorder->restart();
  for (RunObserver* one : observers) one->restart();
}

/// Saves the requested snapshot once its time is reached, `slack` [s] early at most.
void Simulation::State::save_due_snapshot(double slack) {
  if (!snapshot_due || world().time() < options.snapshot_at - slack) return;
  session->save(options.snapshot);
  snapshot_due = false;
}

/// Order within a step: inputs, snapshot, step, record. A snapshot therefore holds the commands
/// that were given at the start of its step.
void Simulation::State::step() {
  inform();
  save_due_snapshot(0);
  session->step();
  // All that a step changes is recorded before the next one.
  if (recorder) recorder->observe();
  for (RunObserver* one : observers) one->after_step();
}

/// Informs the observers that no step follows, before files are closed.
void Simulation::State::close() {
  for (RunObserver* one : observers) one->closing();
}

/// Closes everything after a failure. Observers finish after the recorder: the summary and
/// failed.snapshot are more important than a published map.
void Simulation::State::fail(const std::string& cause) noexcept {
  // The first cause is what the user reads; the recorder logs a second one.
  const auto attempt = [](const auto& work) {
    try {
      work();
    } catch (const std::exception& error) {
      log(LogLevel::kError, std::string("after the failure: ") + error.what());
    }
  };
  attempt([&] { close(); });
  if (recorder) attempt([&] { recorder->finish("failed", cause); });
  if (recorder) attempt([&] { results = recorder->folder(); });
  recorder.reset();
  for (RunObserver* one : std::exchange(observers, {})) attempt([&] { one->finish(); });
}

/// Classifies the present state as the end of a run. An interruption is reported even if the
/// programs happen to be complete, as results may be missing.
RunEnd Simulation::State::end_now(bool requested, const std::string& interrupted_by) const {
  RunEnd end;
  end.time = world().time();
  end.cause = interrupted_by;
  if (!interrupted_by.empty()) {
    end.reason = EndReason::kInterrupted;
  } else if (session->forbidden()) {
    end.reason = EndReason::kForbidden;
    end.cause = session->forbidden()->text();
  } else if (session->complete()) {
    end.cause = missed_goals(*session);
    end.reason = end.cause.empty() ? EndReason::kComplete : EndReason::kMissedGoal;
  } else if (session->fell_short()) {
    end.reason = EndReason::kFellShort;
  } else {
    end.reason = requested ? EndReason::kEndRequested : EndReason::kOutOfTime;
  }
  end.snapshot_missed = snapshot_due;
  return end;
}

/// Returns why a run is not finished: the cause of an interruption, the forbidden event, or the
/// programs that did not reach their end. Empty for a finished run.
std::string Simulation::State::message_of(const RunEnd& end) const {
  if (!end.cause.empty() || end.reason == EndReason::kComplete) return end.cause;
  std::string out;
  for (const session::ProgramReport& report : session->programs()) {
    if (report.by_inputs() || report.last().state == control::StepState::kDone) continue;
    const auto machine = static_cast<std::size_t>(report.machine);
    const std::string& name = world().description().machines[machine].name;
    out += (out.empty() ? "" : "; ") +
           session::report_line(report, name, "the caller or the controller ended the run");
  }
  return out.empty() ? "the caller or the controller ended the run" : out;
}

/// Observers finish before the recorder, so that their failure is part of the summary.
RunEnd Simulation::State::finish(RunEnd end) {
  close();
  // Missing output that was asked for must not go unnoticed.
  if (std::exchange(snapshot_due, false))
    log(LogLevel::kError, "no snapshot: the run ended at " + short_text(end.time) +
                              " s, before --snapshot-at " + short_text(options.snapshot_at));
  try {
    inform();
    for (RunObserver* one : observers) one->finish();
  } catch (const std::exception& error) {
    observers.clear();
    fail(error.what());
    throw;
  }
  observers.clear();
  // The folder is closed even if one of its files cannot be written.
  const std::unique_ptr<record::Recorder> closing = std::move(recorder);
  if (!closing) return end;
  try {
    closing->finish(status_of(end.reason), message_of(end));
  } catch (const std::exception&) {
    results = closing->folder();
    throw;
  }
  results = closing->folder();
  const record::RunStatus& about = closing->status();
  end.pictures = about.frames;
  end.wall_time = about.wall_time + about.render_time + about.record_time;
  end.drawing_time = about.render_time;
  end.encoding_time = about.encode_time;
  return end;
}

void Simulation::step(int n) {
  try {
    for (int i = 0; i < n; ++i) state_->step();
  } catch (const std::exception& error) {
    state_->fail(error.what());
    throw;
  }
}

RunEnd Simulation::run_to_end(const LoopHooks& hooks) {
  State& s = *state_;
  const auto interrupted = [&] { return hooks.interrupted ? hooks.interrupted() : std::string(); };
  bool requested = false;
  // Hooks run within the try block: a controller that throws makes the run a failed one.
  try {
    while (!done() && !requested && interrupted().empty()) {
      requested = hooks.before_step && !hooks.before_step();
      if (requested) break;
      s.step();
      if (hooks.progress) hooks.progress(progress());
    }
    // The state of the end may be the one to save.
    s.save_due_snapshot(0.5 * s.world().dt());
  } catch (const std::exception& error) {
    s.fail(error.what());
    // The type of the exception says which kind of failure it was.
    throw;
  }
  return s.finish(s.end_now(requested, interrupted()));
}

bool Simulation::done() const { return state_->session->done(); }

RunEnd Simulation::finish(const std::string& interrupted_by) {
  return state_->finish(state_->end_now(!done(), interrupted_by));
}

void Simulation::fail(const std::string& cause) noexcept { state_->fail(cause); }

/// A load that fails half way leaves no usable state, so the one before comes back.
template <class Load>
void Simulation::State::replace(const Load& load) {
  const std::vector<char> before = saved(*session);
  try {
    load();
  } catch (...) {
    load_saved(before, *session);
    throw;
  }
  ++replacements;
  replaced = true;
}

void Simulation::reset() {
  state_->replace([&] { load_saved(state_->start, *state_->session); });
}

void Simulation::reset(std::uint64_t seed) {
  State& s = *state_;
  scene::Scene scene = s.world().description();
  if (seed == scene.seed) return reset();
  if (s.recorder || !s.observers.empty())
    throw Error(
        "another seed makes another ground: finish the recording and detach observers first");
  reseed(scene, seed);
  // The new world is complete before the old one is released, so a failure changes nothing.
  std::unique_ptr<session::Session> next = s.make_session(std::move(scene));
  for (const std::string& link : s.options.watch) next->watch(link);
  if (s.options.soil_energy) next->keep_soil_energy();
  s.start = saved(*next);
  s.pictures.reset();
  s.session = std::move(next);
  s.status.start_time = 0;
  ++s.replacements;
}

void Simulation::save(const std::string& path) const { state_->session->save(path); }

void Simulation::load(const std::string& path, bool anyway) {
  state_->replace([&] { state_->session->load(path, anyway); });
}

std::uint64_t Simulation::replacements() const { return state_->replacements; }

const std::vector<sim::Channel>& Simulation::inputs() const { return world().inputs().channels(); }
const std::vector<sim::Channel>& Simulation::outputs() const {
  return world().outputs().channels();
}
int Simulation::input(const std::string& name) const { return world().inputs().index(name); }
int Simulation::output(const std::string& name) const { return world().outputs().index(name); }
void Simulation::set(int input, double value) { state_->session->set(input, value); }
double Simulation::get(int output) const { return world().outputs().get(output); }
const sim::ArrayOutputs& Simulation::arrays() const { return world().arrays(); }

void Simulation::watch(const std::string& link) {
  state_->session->watch(link);
  // Kept for a session that another seed makes.
  state_->options.watch.push_back(link);
}

void Simulation::order(const std::string& machine, const std::string& steps, bool now) {
  state_->session->order(machine, steps, now);
}

heightfield::TerrainView Simulation::heights() const {
  return sim::terrain_view(world(), heightfield::SurfaceKind::kMapped);
}

std::vector<heightfield::CellRect> Simulation::changed() {
  return state_->follower.take(heights());
}

render::Image Simulation::image(const std::string& camera) {
  State& s = *state_;
  // The drawing context of the recorder serves where there is one: another would build the ground's
  // mesh again.
  if (s.recorder) return s.recorder->draw(camera);
  if (!s.pictures) s.pictures = std::make_unique<record::CameraPictures>(*s.session);
  return s.pictures->draw(camera);
}

double Simulation::time() const { return world().time(); }

RunProgress Simulation::progress() const {
  const State& s = *state_;
  RunProgress out;
  out.time = s.world().time();
  out.duration = s.world().description().recording.duration;
  // The time before a resumed snapshot does not count for the speed of this process.
  const double spent = s.total.seconds();
  out.real_time_factor = spent > 0 ? (out.time - s.status.start_time) / spent : 0;
  out.remaining = record::wall_time_left(out.duration - out.time, out.real_time_factor);
  out.particles = s.world().soil().counts().particles;
  out.cycles = static_cast<int>(s.session->cycles().size());
  out.pictures = s.recorder ? s.recorder->status().frames : 0;
  out.phase = s.world().description().machines.empty() ? "" : s.session->phase(0);
  return out;
}

std::string Simulation::results_folder() const {
  return state_->recorder ? state_->recorder->folder() : state_->results;
}

std::string Simulation::summary(bool with_hash) const {
  const State& s = *state_;
  if (s.recorder) return s.recorder->summary(with_hash);
  // Without a folder nothing is drawn or written, so the wall time is that of the simulation.
  record::RunStatus status = s.status;
  status.wall_time = s.total.seconds();
  if (done()) status.status = status_of(s.end_now(false, "").reason);
  return record::summary_json(*s.session, status, with_hash);
}

std::string Simulation::state_hash() const { return state_->session->state_hash(); }
const session::Session& Simulation::session() const { return *state_->session; }
const sim::World& Simulation::world() const { return state_->world(); }

void Simulation::attach(RunObserver& observer) { state_->observers.push_back(&observer); }

void Simulation::detach(RunObserver& observer) {
  std::vector<RunObserver*>& all = state_->observers;
  all.erase(std::remove(all.begin(), all.end(), &observer), all.end());
}

}  // namespace navvy::run
