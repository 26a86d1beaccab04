// SPDX-License-Identifier: Apache-2.0
#include "record/telemetry.h"

#include <cstdio>
#include <utility>

#include "core/file.h"

namespace navvy::record {

Telemetry::Telemetry(const sim::Session& session, std::string path) : session_(session), path_(std::move(path)) {
  const auto& world = session_.world();
  for (const sim::Channel& channel : world.outputs()) {
    if (!text_.empty()) text_ += ',';
    text_ += channel.name + " [" + channel.unit + "]";
  }
  for (const scene::MachineInWorld& machine : world.description().machines) text_ += "," + machine.name + "/phase";
  text_ += '\n';
}

void Telemetry::sample() {
  const auto& world = session_.world();
  char number[32];
  for (std::size_t i = 0; i < world.outputs().size(); ++i) {
    const int n = std::snprintf(number, sizeof number, i == 0 ? "%.6g" : ",%.7g", world.get(static_cast<int>(i)));
    text_.append(number, static_cast<std::size_t>(n));
  }
  for (std::size_t m = 0; m < world.description().machines.size(); ++m)
    text_ += "," + session_.phase(static_cast<int>(m));
  text_ += '\n';
  ++rows_;
}

void Telemetry::checkpoint(bool force) {
  if (!force && rows_ < written_rows_ + written_rows_ / 10 + 25) return;
  write_file_atomically(path_, text_);
  written_rows_ = rows_;
}

}  // namespace navvy::record
