// SPDX-License-Identifier: Apache-2.0
#include "soak/scooping.h"

#include <cmath>
#include <exception>

#include "control/step_kinds.h"
#include "core/error.h"
#include "core/log.h"
#include "core/math.h"
#include "paths.h"
#include "scene_io/loader.h"

namespace navvy::soak {
namespace {

/// Commanded pose of the bucket, linear in between [s, m, m, deg].
struct Knot {
  double time, x, z, curl;
};
// High above, down to the sand, 0.25 m into it, dragged, curled, lifted, carried back over the cut,
// tipped, up and away until most of the sand is inactive. The dumped soil refills the cut, so that
// every cycle starts from nearly the same ground.
constexpr Knot kPath[] = {{0, -0.8, 1.4, -70},   {0.7, -0.8, 0.45, -70},  {1.3, -0.6, 0.15, -70},
                          {2.3, 0.3, 0.15, -62}, {2.8, 0.45, 0.45, 0},    {3.2, 0.45, 0.8, 0},
                          {3.6, -0.3, 0.8, 0},   {4.1, -0.3, 0.8, -150},  {4.5, -0.3, 0.8, -150},
                          {5, -0.8, 1.4, -70},   {kCycle, -0.8, 1.4, -70}};

const char* const kJoints[] = {"bucket/slide_x/position", "bucket/slide_z/position",
                               "bucket/curl/position"};

scene::Scene load(std::string& text) {
  return scene_io::load_scene(navvy::source_dir() + "/tests/soak/scoops.sdf", control::step_kinds(),
                              {}, &text);
}

}  // namespace

Scooping::Scooping(device::Device& device, const std::string& from, const std::string& record)
    : device_(device) {
  record::Options options;
  options.directory = record;
  options.render = false;
  session_ = std::make_unique<session::Session>(load(options.scene_text), device);
  if (!from.empty()) session_->load(from);
  const double dt = session_->world().dt();
  steps_in_cycle_ = static_cast<std::uint64_t>(std::llround(kCycle / dt));
  if (std::abs(static_cast<double>(steps_in_cycle_) * dt - kCycle) > 1e-9)
    throw Error("the base step of " + std::to_string(dt) +
                " s does not divide a cycle of the soak");
  for (std::size_t i = 0; i < inputs_.size(); ++i)
    inputs_[i] = session_->world().inputs().index(kJoints[i]);
  if (!record.empty()) recorder_ = std::make_unique<record::Recorder>(*session_, options);
}

Scooping::~Scooping() {
  try {
    if (recorder_) recorder_->finish("interrupted", "the soak ended here");
  } catch (const std::exception& error) {
    log_warning(error.what());
  }
}

void Scooping::command(double time) {
  std::size_t k = 0;
  while (k + 2 < std::size(kPath) && kPath[k + 1].time <= time) ++k;
  const Knot &a = kPath[k], &b = kPath[k + 1];
  const double u = (time - a.time) / (b.time - a.time);
  session_->set(inputs_[0], a.x + u * (b.x - a.x));
  session_->set(inputs_[1], a.z + u * (b.z - a.z));
  session_->set(inputs_[2], (a.curl + u * (b.curl - a.curl)) * kPi / 180);
}

void Scooping::cycle() {
  const double dt = session_->world().dt();
  do {
    command(static_cast<double>(session_->world().steps() % steps_in_cycle_) * dt);
    session_->step();
    if (recorder_) recorder_->observe();
  } while (session_->world().steps() % steps_in_cycle_ != 0);
}

long Scooping::cycles() const {
  return static_cast<long>(session_->world().steps() / steps_in_cycle_);
}

Phase Scooping::phase() const {
  const sim::World& world = session_->world();
  Phase out;
  out.cycle = cycles();
  out.time = world.time();
  out.particles = world.soil().counts().particles;
  out.ledger = world.soil().mass_ledger().error;
  out.hash = session_->state_hash();
  out.bytes = bytes_in_use(device_.memory_used());
  return out;
}

}  // namespace navvy::soak
