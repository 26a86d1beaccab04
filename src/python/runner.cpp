// SPDX-License-Identifier: Apache-2.0
#include "python/runner.h"

#include "core/saved_state.h"
#include "core/stopwatch.h"
#include "device/process_fork.h"
#include "python/kept_messages.h"
#include "scene/parameters.h"
#include "sim/world_terrain.h"

namespace navvy::python {
namespace {

/// Wall time between two calls of a poll [s].
constexpr double kPollTime = 0.02;

/// Gives a scene another seed. Hills without a seed of their own got the scene's seed when they
/// were read; they are recognised by it and follow the change.
void reseed(scene::Scene& scene, std::uint64_t seed) {
  for (scene::GroundFeature& feature : scene.ground.features)
    if (feature.seed == scene.seed) feature.seed = seed;
  scene.seed = seed;
}

scene::Scene without_programs(scene::Scene scene) {
  for (scene::MachineInWorld& machine : scene.machines) machine.program.steps.clear();
  return scene;
}

}  // namespace

Runner::Runner(scene::Scene scene, LiveSession::Options options, bool programs)
    : options_(std::move(options)) {
  if (!programs) scene = without_programs(std::move(scene));
  live_ = std::make_shared<LiveSession>(std::move(scene), options_);
}

Runner::Runner(Runner& other) : options_(other.options_), failure_(other.failure_) {
  const QuietHere quiet;
  live_ = std::make_shared<LiveSession>(other.world().description(), options_);
  live_->load(saved(other.session()));
}

Runner::Use::Use(Runner& runner) : runner_(runner) {
  device::require_no_fork();
  if (runner_.busy_.exchange(true))
    throw BusyError(
        "another thread is inside this world; give each thread a world of its own (fork), or let "
        "one thread wait for the other");
  if (runner_.live_ == nullptr) {
    runner_.busy_ = false;
    throw ClosedError("this world was closed; make another one");
  }
}

Runner::Use::~Use() { runner_.busy_ = false; }

session::Session& Runner::session() { return live_->session(); }
const sim::World& Runner::world() { return live_->session().world(); }

void Runner::step(int n, const Poll& poll) {
  if (!failure_.empty())
    throw SimulationError("the world failed before, and keeps its last state: " + failure_ +
                          "; use reset or load");
  Stopwatch watch;
  try {
    for (int i = 0; i < n; ++i) {
      session().step();
      if (watch.seconds() < kPollTime) continue;
      poll();
      watch.restart();
    }
  } catch (const SimulationError& error) {
    failure_ = error.what();
    throw;
  }
}

void Runner::reset(const std::uint64_t* seed) {
  if (seed == nullptr || *seed == world().description().seed) {
    live_->load(std::vector<char>(live_->start()));
  } else {
    scene::Scene scene = world().description();
    reseed(scene, *seed);
    // The new world is complete before the old one is released, so a failure changes nothing.
    live_ = std::make_shared<LiveSession>(std::move(scene), options_);
    // Copies have the old seed.
    pool_.clear();
  }
  failure_.clear();
}

std::vector<char> Runner::save() { return session().snapshot(); }

void Runner::load(const std::vector<char>& bytes, bool anyway) {
  // A load that fails half way leaves no usable state, so the one before comes back.
  const std::vector<char> before = saved(session());
  try {
    session().restore(bytes, anyway);
  } catch (...) {
    live_->load(before);
    throw;
  }
  failure_.clear();
}

void Runner::copy_to(Runner& other) {
  if (world().start() != other.world().start())
    throw InputError(Fault{Fault::Severity::kError, "", 0, "fork", "into",
                           "the other world has another scene or seed: " +
                               scene::differences(other.world().start(), world().start()),
                           "give worlds that fork returned"});
  other.live_->load(saved(session()));
  other.failure_.clear();
}

std::vector<heightfield::CellRect> Runner::refresh_heights() {
  return heights_.update(sim::mapped_surface(world()));
}
std::vector<heightfield::CellRect> Runner::refresh_columns() {
  return columns_.update(sim::terrain_view(world(), heightfield::SurfaceKind::kColumns));
}

void Runner::close() {
  pool_.clear();
  live_.reset();
}

}  // namespace navvy::python
