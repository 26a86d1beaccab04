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

/// Returns the fields of the NPY, in the order of the columns.
std::vector<RecordField> fields_of(const session::Session& session) {
  std::vector<RecordField> fields;
  // The first channel is time.
  for (const sim::Channel& channel : session.world().outputs())
    fields.push_back({channel.name, fields.empty() ? "<f8" : "<f4", {}});
  for (const scene::MachineInWorld& machine : session.world().description().machines)
    fields.push_back({machine.name + "/phase", "|S" + std::to_string(Telemetry::kPhaseBytes), {}});
  return fields;
}

/// Returns the size of a row in the NPY [bytes].
std::size_t record_bytes(const session::Session& session) {
  return 8 + 4 * (session.world().outputs().size() - 1) +
         Telemetry::kPhaseBytes * session.world().description().machines.size();
}

}  // namespace

Telemetry::Telemetry(const session::Session& session, std::string csv, std::string npy)
    : session_(session),
      rows_(std::move(csv), header_of(session)),
      records_(std::move(npy), fields_of(session), record_bytes(session)),
      channels_(session.world().outputs().size()) {}

std::string time_stamp(double time) {
  // Twelve digits distinguish the shortest steps after a million seconds, the maximum duration.
  char text[32];
  return std::string(text,
                     static_cast<std::size_t>(std::snprintf(text, sizeof text, "%.12g", time)));
}

void Telemetry::sample() {
  const auto& world = session_.world();
  row_ = time_stamp(world.outputs().get(0));
  record_.clear();
  put_number(record_, world.outputs().get(0));
  // Seven digits resolve some hundred metres to 0.1 mm.
  char number[32];
  // snprintf instead of a stream, as formatting is most of the cost of a row.
  for (std::size_t i = 1; i < channels_; ++i) {
    const double value = world.outputs().get(static_cast<int>(i));
    const int n = std::snprintf(number, sizeof number, ",%.7g", value);
    row_.append(number, static_cast<std::size_t>(n));
    put_number(record_, static_cast<float>(value));
  }
  for (std::size_t m = 0; m < world.description().machines.size(); ++m) {
    std::string phase = session_.phase(static_cast<int>(m));
    row_ += "," + phase;
    phase.resize(kPhaseBytes, '\0');
    record_ += phase;
  }
  rows_.add(row_);
  records_.add(record_);
}

void Telemetry::checkpoint(bool end) {
  end ? rows_.sync() : rows_.flush();
  end ? records_.sync() : records_.flush();
}

void Telemetry::move_to(const std::string& csv, const std::string& npy) {
  rows_.move_to(csv);
  records_.move_to(npy);
}

}  // namespace navvy::record
