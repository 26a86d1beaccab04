// SPDX-License-Identifier: Apache-2.0
#include "record/map_recorder.h"

#include <algorithm>
#include <cstdio>
#include <optional>
#include <utility>

#include "core/edit_distance.h"
#include "planner/formats/formats.h"
#include "planner/map_maker.h"
#include "planner/ros/streams.h"
#include "planner/sources.h"
#include "sim/timing.h"
#include "sim/world_terrain.h"

namespace navvy::record {
namespace {

using planner::Layer;

std::vector<Layer> layers_of(const scene::MapRecord& record) {
  if (record.layers.empty()) return planner::format_named(record.format).by_default;
  std::vector<Layer> out;
  for (const std::string& name : record.layers) out.push_back(planner::layer_named(name));
  return out;
}

bool is_bag(const scene::MapRecord& record) {
  return record.format == "mcap" || record.format == "bag";
}

}  // namespace

std::vector<Fault> check_records(const scene::Scene& scene) {
  std::vector<Fault> faults;
  for (const scene::MapRecord& record : scene.records) {
    const auto add = [&](Fault fault, const char* child) {
      fault.file = scene.file;
      fault.line = record.line;
      fault.element = "world/navvy:record[" + record.name + "]/" + child;
      faults.push_back(std::move(fault));
    };
    try {
      if (planner::format_named(record.format).needs_design && !scene.design.any())
        add({Fault::Severity::kError, "", 0, "", record.format,
             "needs a design: without one nothing is to be dug", "give the scene a <navvy:design>"},
            "format");
    } catch (const InputError& error) {
      add(error.faults().front(), "format");
    }
    if (record.machine_rate > 0 && !is_bag(record))
      add({Fault::Severity::kError, "", 0, "", record.format, "only mcap and bag hold machines",
           "leave it away"},
          "machine_rate_hz");
    for (const std::string& name : record.layers) try {
        planner::layer_named(name);
      } catch (const InputError& error) {
        add(error.faults().front(), "layers");
      }
  }
  return faults;
}

struct MapRecorder::Stream {
  Stream(const scene::MapRecord& r, planner::MapOptions options)
      : record(r), label(r.name), layers(layers_of(r)), maker(std::move(options)) {}
  double machine_rate() const {
    return record.machine_rate > 0 ? record.machine_rate : record.kMachineRate;
  }

  scene::MapRecord record;
  std::string label;  ///< of its files now
  std::vector<Layer> layers;
  planner::MapMaker maker;
  std::unique_ptr<planner::ros::Bag> bag;
};

MapRecorder::MapRecorder(const session::Session& session, RunFolder& folder)
    : session_(session), folder_(folder) {
  const scene::Scene& scene = session.world().description();
  std::vector<Fault> faults = check_records(scene);
  if (!faults.empty()) throw InputError(std::move(faults));
  for (const scene::MapRecord& record : scene.records) taken_.insert(record.name);
  for (const scene::MapRecord& record : scene.records) {
    // Pictures and points need the surface.
    std::vector<Layer> layers = layers_of(record);
    layers.push_back(Layer::kElevation);
    streams_.push_back(std::make_unique<Stream>(
        record, planner::options_for(scene, session.world().ground(), std::move(layers),
                                     session.design())));
    open(*streams_.back());
  }
}

void MapRecorder::open(Stream& stream) {
  const std::string& label = stream.label;
  if (stream.record.format == "mcap")
    stream.bag = planner::ros::make_mcap(folder_.path(label + ".mcap"));
  if (stream.record.format == "bag") {
    // Both files are the run's before they are there.
    const std::string data = folder_.path(label + "/" + label + "_0.db3");
    folder_.path(label + "/metadata.yaml");
    stream.bag = planner::ros::make_bag_folder(data.substr(0, data.rfind('/')));
  }
}

void MapRecorder::restart() {
  for (const auto& stream : streams_) {
    if (stream->bag) stream->bag->close();
    for (int number = 2; !taken_.insert(stream->label).second; ++number)
      stream->label = stream->record.name + "_" + std::to_string(number);
    stream->maker.forget();
    open(*stream);
  }
}

MapRecorder::~MapRecorder() = default;

void MapRecorder::observe() {
  const sim::World& world = session_.world();
  std::optional<heightfield::TerrainView> view;
  for (const auto& stream : streams_) {
    const scene::MapRecord& record = stream->record;
    const auto due = [&](double rate) { return sim::sample_due(world.steps(), world.dt(), rate); };
    const bool map_due = due(record.rate),
               machines_due = stream->bag && due(stream->machine_rate());
    const std::int64_t now = planner::ros::stamp(world.time());
    if (stream->bag && (map_due || machines_due)) planner::ros::write_clock(*stream->bag, now);
    if (machines_due) planner::ros::write_machines(*stream->bag, world, now);
    if (!map_due) continue;
    // One view for all: it costs a pass over the particles.
    if (!view) view = sim::terrain_view(world, heightfield::SurfaceKind::kMapped);
    stream->maker.update(*view);
    const planner::TerrainMap map = stream->maker.map();
    if (stream->bag) {
      planner::ros::write_map(*stream->bag, map, stream->layers, now);
      continue;
    }
    const planner::Format& format = planner::format_named(record.format);
    char number[24];
    std::snprintf(number, sizeof number, "_%05llu",
                  static_cast<unsigned long long>(
                      sim::sample_number(world.steps(), world.dt(), record.rate)));
    // All its files are the run's before they are there.
    const std::string name = "maps/" + stream->label + number + format.extension;
    for (const std::string& file : planner::files_of(format, name)) folder_.path(file);
    format.write(map, stream->layers, folder_.directory() + "/" + name);
  }
}

void MapRecorder::finish() {
  for (const auto& stream : streams_)
    if (stream->bag) stream->bag->close();
}

}  // namespace navvy::record
