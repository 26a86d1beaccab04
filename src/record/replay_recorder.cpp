// SPDX-License-Identifier: Apache-2.0
#include "record/replay_recorder.h"

#include <nlohmann/json.hpp>
#include <utility>

#include "record/replay_packing.h"
#include "sim/timing.h"

namespace navvy::record {

using nlohmann::json;

ReplayRecorder::ReplayRecorder(const session::Session& session, std::string path)
    : session_(session),
      frames_(session, kMostParticles),
      file_(std::move(path), replay_row(frames_.header(kRate))) {}

void ReplayRecorder::observe() {
  const sim::World& world = session_.world();
  if (count_ > 0 && !sim::sample_due(world.steps(), world.dt(), kRate)) return;
  add_frame(count_ % kKeyEvery == 0);
}

void ReplayRecorder::restart() { add_frame(true); }

void ReplayRecorder::finish() {
  if (count_ == 0 || session_.world().steps() != last_step_) add_frame(false);
}

void ReplayRecorder::add_frame(bool key) {
  json frame = frames_.frame();
  frame["key"] = key;
  frame["tiles"] = packed(frames_.tiles(key));
  file_.add(replay_row(frame));
  ++count_;
  last_step_ = session_.world().steps();
}

void ReplayRecorder::add_picture(const std::string& camera, std::uint64_t number,
                                 const Pose& X_WC) {
  file_.add(replay_row({{"picture", camera},
                        {"number", number},
                        {"time_s", session_.world().time()},
                        {"pose", json_of(X_WC)}}));
}

}  // namespace navvy::record
