// SPDX-License-Identifier: Apache-2.0
#include "record/telemetry.h"

#include <cstdio>
#include <utility>

namespace navvy::record {

namespace {

/// Returns the column names: outputs, then the phases of the machines as text.
std::string header_of(const session::Session& session) {
  std::string header;
  for (const sim::Channel& channel : session.world().outputs()) {
    if (!header.empty()) header += ',';
    header += channel.name + " [" + channel.unit + "]";
  }
  for (const scene::MachineInWorld& machine : session.world().description().machines)
    header += "," + machine.name + "/phase";
  return header;
}

}  // namespace

Telemetry::Telemetry(const session::Session& session, std::string path)
    : session_(session),
      file_(std::move(path), header_of(session)),
      channels_(session.world().outputs().size()) {}

std::string time_stamp(double time) {
  // Twelve digits distinguish the shortest steps after a million seconds, the maximum duration.
  char text[32];
  return std::string(text,
                     static_cast<std::size_t>(std::snprintf(text, sizeof text, "%.12g", time)));
}

void Telemetry::sample() {
  const auto& world = session_.world();
  // The first channel is time.
  row_ = time_stamp(world.outputs().get(0));
  // Seven digits resolve some hundred metres to 0.1 mm.
  char number[32];
  // snprintf instead of a stream, as formatting is most of the cost of a row.
  for (std::size_t i = 1; i < channels_; ++i) {
    const int n =
        std::snprintf(number, sizeof number, ",%.7g", world.outputs().get(static_cast<int>(i)));
    row_.append(number, static_cast<std::size_t>(n));
  }
  for (std::size_t m = 0; m < world.description().machines.size(); ++m)
    row_ += "," + session_.phase(static_cast<int>(m));
  file_.add(row_);
}

}  // namespace navvy::record
