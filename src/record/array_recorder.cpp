// SPDX-License-Identifier: Apache-2.0
#include "record/array_recorder.h"

#include <nlohmann/json.hpp>
#include <string>

#include "core/error.h"
#include "core/file.h"

namespace navvy::record {
namespace {

/// Returns the file of an array within the run's folder.
std::string file_of(const sim::ArrayChannel& channel) { return "arrays/" + channel.name + ".npy"; }

/// Returns what a reader needs beside the numbers.
nlohmann::json entry_of(const sim::ArrayChannel& channel) {
  return {{"name", channel.name},    {"file", file_of(channel)},
          {"unit", channel.unit},    {"type", sim::name_of(channel.type)},
          {"frame", channel.frame},  {"shape", channel.shape},
          {"rate_hz", channel.rate}, {"meaning", channel.meaning}};
}

}  // namespace

ArrayRecorder::ArrayRecorder(const session::Session& session, RunFolder& folder)
    : session_(session), folder_(folder) {}

/// Opens files for arrays that were declared since the last call: samplers may be added during a
/// run.
void ArrayRecorder::open_new() {
  const std::vector<sim::ArrayChannel>& channels = session_.world().arrays().channels();
  if (streams_.size() == channels.size()) return;
  for (std::size_t i = streams_.size(); i < channels.size(); ++i)
    streams_.push_back(
        {std::make_unique<ArrayFile>(folder_.path(file_of(channels[i])), channels[i]), 0});
  write_index();
}

void ArrayRecorder::write_index() {
  const std::vector<sim::ArrayChannel>& channels = session_.world().arrays().channels();
  nlohmann::json index = nlohmann::json::array();
  for (const sim::ArrayChannel& channel : channels) index.push_back(entry_of(channel));
  write_file_atomically(folder_.path("arrays/index.json"),
                        index.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n");
}

void ArrayRecorder::observe() {
  open_new();
  for (std::size_t i = 0; i < streams_.size(); ++i) {
    const sim::ArrayView value = session_.world().arrays().view(static_cast<int>(i));
    // An array that was not published has sequence 0 and no record.
    if (value.sequence() == streams_[i].sequence) continue;
    streams_[i].sequence = value.sequence();
    streams_[i].file->add(value);
  }
}

void ArrayRecorder::restart() {
  open_new();
  for (std::size_t i = 0; i < streams_.size(); ++i)
    streams_[i].sequence = session_.world().arrays().view(static_cast<int>(i)).sequence();
}

void ArrayRecorder::move_out() {
  const std::vector<sim::ArrayChannel>& channels = session_.world().arrays().channels();
  for (std::size_t i = 0; i < streams_.size(); ++i)
    streams_[i].file->move_to(folder_.path(file_of(channels[i])));
  if (!streams_.empty()) write_index();
}

void ArrayRecorder::checkpoint(bool end) {
  for (const Stream& stream : streams_) end ? stream.file->sync() : stream.file->flush();
}

}  // namespace navvy::record
