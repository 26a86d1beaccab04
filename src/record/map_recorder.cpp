// SPDX-License-Identifier: Apache-2.0
#include "record/map_recorder.h"

#include <algorithm>
#include <cstdio>
#include <optional>
#include <utility>

#include "core/edit_distance.h"
#include "formats/formats.h"
#include "formats/ros/array_message.h"
#include "formats/ros/streams.h"
#include "map/map_maker.h"
#include "map/map_sources.h"
#include "record/machine_topics.h"
#include "sim/timing.h"
#include "sim/world_terrain.h"

namespace navvy::record {
namespace {

using map::MapLayer;

// A record without layers takes those of its format.
std::vector<map::MapLayer> layers_of(const scene::MapRecord& record) {
  if (record.layers.empty()) return formats::format_named(record.format).by_default;
  std::vector<map::MapLayer> out;
  for (const std::string& name : record.layers) out.push_back(map::layer_named(name));
  return out;
}

bool is_bag(const formats::MapFormat& format) { return format.open_bag != nullptr; }

/// `formats` must not include `sim`, so each has an enumeration of its own.
formats::ros::ArrayElement element_of(sim::ElementType type) {
  switch (type) {
    case sim::ElementType::kUint8:
      return formats::ros::ArrayElement::kUint8;
    case sim::ElementType::kUint16:
      return formats::ros::ArrayElement::kUint16;
    case sim::ElementType::kInt32:
      return formats::ros::ArrayElement::kInt32;
    case sim::ElementType::kFloat32:
      return formats::ros::ArrayElement::kFloat32;
    case sim::ElementType::kFloat64:
      break;
  }
  return formats::ros::ArrayElement::kFloat64;
}

}  // namespace

// The reader of scenes knows neither formats nor layers, so their names are checked here.
std::vector<Fault> check_records(const scene::Scene& scene) {
  std::vector<Fault> faults;
  for (const scene::MapRecord& record : scene.records) {
    const auto add = [&](Fault fault, const char* child) {
      fault.file = scene.file;
      fault.line = record.line;
      fault.element = "world/navvy:record[" + record.name + "]/" + child;
      faults.push_back(std::move(fault));
    };
    const formats::MapFormat* format = nullptr;
    try {
      format = &formats::format_named(record.format);
      if (format->needs_design && !scene.design.any())
        add({Fault::Severity::kError, "", 0, "", record.format,
             "needs a design: without one nothing is to be dug", "give the scene a <navvy:design>"},
            "format");
    } catch (const InputError& error) {
      add(error.faults().front(), "format");
    }
    // An unknown format has been reported; a rate for machines is refused there as well.
    if (record.machine_rate > 0 && (format == nullptr || !is_bag(*format)))
      add({Fault::Severity::kError, "", 0, "", record.format, "only mcap and bag hold machines",
           "remove it"},
          "machine_rate_hz");
    for (const std::string& name : record.layers) try {
        map::layer_named(name);
      } catch (const InputError& error) {
        add(error.faults().front(), "layers");
      }
  }
  return faults;
}

struct MapRecorder::Stream {
  Stream(const scene::MapRecord& r, map::MapOptions options, const sim::World& world,
         const std::vector<SensorStream>& sensors)
      : record(r),
        format(formats::format_named(r.format)),
        label(r.name),
        layers(layers_of(r)),
        maker(std::move(options)) {
    if (!is_bag(format)) return;
    machines.emplace(world, sensors);
    readings.emplace(sensors, world.arrays());
  }
  double machine_rate() const {
    return record.machine_rate > 0 ? record.machine_rate : record.kMachineRate;
  }

  scene::MapRecord record;
  const formats::MapFormat& format;
  /// Name of its files now.
  std::string label;
  std::vector<map::MapLayer> layers;
  map::MapMaker maker;
  std::unique_ptr<formats::ros::Bag> bag;
  /// Machines in a bag; empty for other formats.
  std::optional<MachineTopics> machines;
  /// Readings of sensors in a bag; empty for other formats.
  std::optional<SensorTopics> readings;
  /// Sequence numbers of the arrays' samples that the bag holds.
  std::vector<std::uint64_t> arrays;
};

MapRecorder::MapRecorder(const session::Session& session, RunFolder& folder,
                         std::vector<SensorStream> sensors)
    : session_(session), folder_(folder), sensors_(std::move(sensors)) {
  const scene::Scene& scene = session.world().description();
  std::vector<Fault> faults = check_records(scene);
  if (!faults.empty()) throw InputError(std::move(faults));
  // All names are taken first, so that no record's second file has the name of another record.
  for (const scene::MapRecord& record : scene.records) taken_.insert(record.name);
  for (const scene::MapRecord& record : scene.records) {
    // Pictures and points need the elevation.
    std::vector<map::MapLayer> layers = layers_of(record);
    layers.push_back(map::MapLayer::kElevation);
    streams_.push_back(std::make_unique<Stream>(
        record,
        map::options_for(scene, session.world().ground(), std::move(layers), session.design()),
        session.world(), sensors_));
    open(*streams_.back());
  }
}

void MapRecorder::open(Stream& stream) {
  if (!is_bag(stream.format)) return;
  stream.arrays.clear();
  stream.machines->restart();
  stream.readings->restart();
  const std::string name = stream.label + stream.format.extension;
  // All its files are listed as the run's before they exist.
  for (const std::string& file : formats::files_of(stream.format, name)) folder_.path(file);
  stream.bag = stream.format.open_bag(folder_.directory() + "/" + name);
}

// An array that was not sampled since the last step has the same sequence number.
void MapRecorder::write_arrays(Stream& stream) {
  const sim::ArrayOutputs& arrays = session_.world().arrays();
  stream.arrays.resize(arrays.channels().size());
  for (std::size_t i = 0; i < stream.arrays.size(); ++i) {
    const sim::ArrayView view = arrays.view(static_cast<int>(i));
    // Number 0 is an array without a sample, which is not written.
    if (view.sequence() == stream.arrays[i]) continue;
    if (stream.readings->has_array(static_cast<int>(i))) continue;
    stream.arrays[i] = view.sequence();
    const sim::ArrayChannel& channel = view.channel();
    formats::ros::write_array(*stream.bag,
                              {channel.name, channel.unit, channel.meaning, channel.frame,
                               element_of(channel.type), channel.shape, view.time(), view.X_WF(),
                               view.bytes(), stream.machines->has_frame(channel.frame)});
  }
}

void MapRecorder::restart() {
  for (const auto& stream : streams_) {
    if (stream->bag) stream->bag->close();
    // The first label is taken by the record itself, so the first restart yields number 2.
    for (int number = 2; !taken_.insert(stream->label).second; ++number)
      stream->label = stream->record.name + "_" + std::to_string(number);
    stream->maker.forget();
    open(*stream);
  }
}

MapRecorder::~MapRecorder() = default;

// Times are compared as step counts, so that rates hold exactly over days.
void MapRecorder::observe() {
  const sim::World& world = session_.world();
  std::optional<heightfield::TerrainView> view;
  for (const auto& stream : streams_) {
    const scene::MapRecord& record = stream->record;
    const auto due = [&](double rate) { return sim::sample_due(world.steps(), world.dt(), rate); };
    const bool map_due = due(record.rate),
               machines_due = stream->bag && due(stream->machine_rate());
    const std::int64_t now = formats::ros::stamp(world.time());
    if (stream->bag && (map_due || machines_due)) formats::ros::write_clock(*stream->bag, now);
    if (stream->bag) stream->machines->observe();
    if (machines_due) stream->machines->write(*stream->bag, now);
    // Arrays have rates of their own, so they are looked at in every step.
    if (stream->bag) {
      stream->readings->write(*stream->bag, now);
      write_arrays(*stream);
    }
    if (!map_due) continue;
    // All records share one view, because it costs a pass over the particles.
    if (!view) view = sim::terrain_view(world, heightfield::SurfaceKind::kMapped);
    stream->maker.update(*view);
    const map::TerrainMap map = stream->maker.map();
    if (stream->bag) {
      formats::ros::write_map(*stream->bag, map, stream->layers, now);
      continue;
    }
    const formats::MapFormat& format = stream->format;
    // Up to number 99999, sorting by name gives the order in time.
    char number[24];
    std::snprintf(number, sizeof number, "_%05llu",
                  static_cast<unsigned long long>(
                      sim::sample_number(world.steps(), world.dt(), record.rate)));
    // All its files are listed as the run's before they exist.
    const std::string name = "maps/" + stream->label + number + format.extension;
    for (const std::string& file : formats::files_of(format, name)) folder_.path(file);
    format.write(map, stream->layers, folder_.directory() + "/" + name);
  }
}

void MapRecorder::finish() {
  for (const auto& stream : streams_)
    if (stream->bag) stream->bag->close();
}

}  // namespace navvy::record
