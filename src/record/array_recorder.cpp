// SPDX-License-Identifier: Apache-2.0
#include "record/array_recorder.h"

#include <cstdio>
#include <nlohmann/json.hpp>
#include <string>

#include "core/error.h"
#include "core/file.h"
#include "render/image.h"
#include "sensor/sensor_output.h"

namespace navvy::record {
namespace {

// Place of a reading's number in the names of pictures, as Python's str.format reads it.
constexpr const char* kReading = "{reading:06}";

/// Returns true if the array is a picture of a colour or a label camera.
bool is_picture(const sim::ArrayChannel& channel, const sensor::SensorOutput* sensor) {
  if (sensor == nullptr) return false;
  const bool colours = channel.type == sim::ElementType::kUint8 && channel.shape.size() == 3 &&
                       channel.shape[2] == 3;
  return colours || (channel.type == sim::ElementType::kUint16 && channel.shape.size() == 2);
}

/// Returns the file of an array within the run's folder. `sensor` is the sensor that publishes it;
/// null if none does.
std::string file_of(const sim::ArrayChannel& channel, const sensor::SensorOutput* sensor) {
  if (is_picture(channel, sensor)) return "sensors/" + channel.name + "_" + kReading + ".png";
  return (sensor != nullptr ? "sensors/" : "arrays/") + channel.name + ".npy";
}

/// Returns the sensor whose array has this index; null if there is none.
const sensor::SensorOutput* sensor_of(const std::vector<sensor::SensorOutput>& sensors,
                                      std::size_t array) {
  for (const sensor::SensorOutput& one : sensors)
    for (const sensor::SensorArray& each : one.arrays)
      if (each.index == static_cast<int>(array)) return &one;
  return nullptr;
}

/// Returns what a reader needs beside the numbers.
nlohmann::json entry_of(const sim::ArrayChannel& channel, const std::string& file) {
  return {{"name", channel.name},    {"file", file},
          {"unit", channel.unit},    {"type", sim::name_of(channel.type)},
          {"frame", channel.frame},  {"shape", channel.shape},
          {"rate_hz", channel.rate}, {"meaning", channel.meaning}};
}

/// Returns the row of a reading: microseconds are enough, and readable.
std::string row_of(const sim::ArrayView& value) {
  char row[96];
  std::snprintf(row, sizeof row, "%llu,%.6f,%.6f,%.6f",
                static_cast<unsigned long long>(value.sequence()), value.time(), value.delivered(),
                value.delivered() - value.time());
  return row;
}

}  // namespace

ArrayRecorder::ArrayRecorder(const session::Session& session, RunFolder& folder)
    : session_(session), folder_(folder) {}

/// Opens files for arrays that were declared since the last call: samplers may be added during a
/// run.
void ArrayRecorder::open_new() {
  const std::vector<sim::ArrayChannel>& channels = session_.world().arrays().channels();
  if (streams_.size() == channels.size()) return;
  const std::vector<sensor::SensorOutput> sensors = sensor::sensor_outputs(session_.world());
  for (std::size_t i = streams_.size(); i < channels.size(); ++i) {
    const sensor::SensorOutput* sensor = sensor_of(sensors, i);
    const std::string name = file_of(channels[i], sensor);
    streams_.push_back({is_picture(channels[i], sensor)
                            ? nullptr
                            : std::make_unique<ArrayFile>(folder_.path(name), channels[i]),
                        0, name});
    // All arrays of a sensor are published together, so one list is enough.
    if (sensor == nullptr || sensor->arrays.front().index != static_cast<int>(i)) continue;
    Stream& stream = streams_.back();
    stream.index_name = "sensors/" + sensor->name + "/index.csv";
    stream.index = std::make_unique<RowFile>(folder_.path(stream.index_name),
                                             "reading,measured_s,delivered_s,latency_s");
  }
  write_index();
}

void ArrayRecorder::write_index() {
  const std::vector<sim::ArrayChannel>& channels = session_.world().arrays().channels();
  nlohmann::json index = nlohmann::json::array();
  for (std::size_t i = 0; i < channels.size(); ++i)
    index.push_back(entry_of(channels[i], streams_[i].name));
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
    if (streams_[i].file != nullptr)
      streams_[i].file->add(value);
    else
      write_picture(streams_[i], value);
    if (streams_[i].index != nullptr) streams_[i].index->add(row_of(value));
  }
}

void ArrayRecorder::write_picture(const Stream& stream, const sim::ArrayView& value) {
  char number[32];
  std::snprintf(number, sizeof number, "%06llu", static_cast<unsigned long long>(value.sequence()));
  std::string name = stream.name;
  name.replace(name.find(kReading), std::string(kReading).size(), number);
  const int height = value.channel().shape[0], width = value.channel().shape[1];
  const std::string path = folder_.path(name);
  if (value.channel().type == sim::ElementType::kUint16) {
    write_file_atomically(path, render::encode_png(width, height, value.values<std::uint16_t>()));
    return;
  }
  const auto rgb = value.values<std::uint8_t>();
  render::write_png(path, {width, height, {rgb.begin(), rgb.end()}});
}

void ArrayRecorder::restart() {
  open_new();
  for (std::size_t i = 0; i < streams_.size(); ++i)
    streams_[i].sequence = session_.world().arrays().view(static_cast<int>(i)).sequence();
}

void ArrayRecorder::move_out() {
  for (Stream& stream : streams_) {
    if (stream.file != nullptr) stream.file->move_to(folder_.path(stream.name));
    if (stream.index != nullptr) stream.index->move_to(folder_.path(stream.index_name));
  }
  if (!streams_.empty()) write_index();
}

void ArrayRecorder::checkpoint(bool end) {
  for (const Stream& stream : streams_) {
    if (stream.file != nullptr) end ? stream.file->sync() : stream.file->flush();
    if (stream.index != nullptr) end ? stream.index->sync() : stream.index->flush();
  }
}

}  // namespace navvy::record
