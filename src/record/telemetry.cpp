// SPDX-License-Identifier: Apache-2.0
#include "record/telemetry.h"

#include <cstdio>
#include <utility>

#include "core/file.h"

namespace navvy::record {

Telemetry::Telemetry(const session::Session& session, std::string path) : session_(session), path_(std::move(path)) {
  const auto& world = session_.world();
  // Fixed here: every row has the columns of the header.
  channels_ = world.outputs().size();
  for (const sim::Channel& channel : world.outputs()) {
    if (!text_.empty()) text_ += ',';
    text_ += channel.name + " [" + channel.unit + "]";
  }
  // Phases are text and come last, where a reader of numbers may stop.
  for (const scene::MachineInWorld& machine : world.description().machines) text_ += "," + machine.name + "/phase";
  text_ += '\n';
}

std::string time_stamp(double time) {
  // Twelve digits tell the shortest steps apart after a million seconds, the longest that a run may last.
  char text[32];
  return std::string(text, static_cast<std::size_t>(std::snprintf(text, sizeof text, "%.12g", time)));
}

void Telemetry::sample() {
  const auto& world = session_.world();
  // The first channel is the time.
  text_ += time_stamp(world.get(0));
  // Seven digits resolve a float of a few hundred metres to 0.1 mm.
  char number[32];
  // No stream: formatting is most of a row's cost.
  for (std::size_t i = 1; i < channels_; ++i) {
    const int n = std::snprintf(number, sizeof number, ",%.7g", world.get(static_cast<int>(i)));
    text_.append(number, static_cast<std::size_t>(n));
  }
  for (std::size_t m = 0; m < world.description().machines.size(); ++m)
    text_ += "," + session_.phase(static_cast<int>(m));
  text_ += '\n';
  ++rows_;
}

void Telemetry::checkpoint(bool force) {
  // A tenth more rows each time: the file is rewritten log(n) times, not n.
  if (!force && rows_ < written_rows_ + written_rows_ / 10 + 25) return;
  write_file_atomically(path_, text_);
  written_rows_ = rows_;
}

}  // namespace navvy::record
