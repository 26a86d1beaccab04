// SPDX-License-Identifier: Apache-2.0
#include "python/live_session.h"

#include <utility>

#include "control/step_kinds.h"
#include "core/saved_state.h"
#include "earthwork/pit_planner.h"
#include "planner/map_path_planner.h"
#include "scene_io/ordered_program.h"
#include "sensor/make_sensors.h"

namespace navvy::python {
namespace {

/// Keeps context and programs of a device for the whole process, so that a world after the last one
/// does not build them again.
void keep_context(const std::string& choice) {
  // Never destroyed: the driver may be gone when static objects are destroyed.
  static auto& kept = *new std::vector<std::pair<std::string, device::Device>>;
  for (const auto& [name, device] : kept)
    if (name == choice) return;
  kept.emplace_back(choice, device::Device(choice));
}

}  // namespace

LiveSession::LiveSession(scene::Scene scene, const Options& options) : device_(options.device) {
  // Samplers are added before any state is loaded, as a state contains theirs.
  session_ = std::make_unique<session::Session>(
      std::move(scene), device_,
      control::Planners{planner::path_planners(), earthwork::job_planners(),
                        scene_io::ordered_program_reader(control::step_kinds())});
  for (std::unique_ptr<sim::Sampler>& one : sensor::make_sensors(session_->world()))
    session_->add(std::move(one));
  for (const std::string& link : options.watch) session_->watch(link);
  start_ = saved(*session_);
  keep_context(options.device);
}

void LiveSession::load(const std::vector<char>& state) { load_saved(state, *session_); }

}  // namespace navvy::python
