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
#include "sim/terrain_view.h"
#include "sim/timing.h"

namespace navvy::record {
namespace {

using planner::Layer;

std::vector<Layer> layers_of(const scene::MapRecord& record) {
  if (record.layers.empty()) return planner::format_named(record.format).by_default;
  std::vector<Layer> out;
  for (const std::string& name : record.layers) out.push_back(planner::layer_named(name));
  return out;
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
      planner::format_named(record.format);
    } catch (const InputError& error) {
      add(error.faults().front(), "format");
    }
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
      : record(r), layers(layers_of(r)), maker(std::move(options)) {}
  scene::MapRecord record;
  std::vector<Layer> layers;
  planner::MapMaker maker;
  std::unique_ptr<planner::ros::Bag> bag;
};

MapRecorder::MapRecorder(const session::Session& session, RunFolder& folder) : session_(session), folder_(folder) {
  const scene::Scene& scene = session.world().description();
  std::vector<Fault> faults = check_records(scene);
  if (!faults.empty()) throw InputError(std::move(faults));
  for (const scene::MapRecord& record : scene.records) {
    // Pictures and points need the surface.
    std::vector<Layer> layers = layers_of(record);
    layers.push_back(Layer::kElevation);
    Stream& stream = *streams_.emplace_back(std::make_unique<Stream>(
        record, planner::options_for(scene, session.world().ground(), std::move(layers), session.design())));
    if (record.format == "mcap") stream.bag = planner::ros::make_mcap(folder.path(record.name + ".mcap"));
    if (record.format == "bag") {
      // Both files are the run's before they are there.
      const std::string data = folder.path(record.name + "/" + record.name + "_0.db3");
      folder.path(record.name + "/metadata.yaml");
      stream.bag = planner::ros::make_bag_folder(data.substr(0, data.rfind('/')));
    }
  }
}

MapRecorder::~MapRecorder() = default;

void MapRecorder::observe() {
  const sim::World& world = session_.world();
  std::optional<heightfield::TerrainView> view;
  for (const auto& stream : streams_) {
    const scene::MapRecord& record = stream->record;
    if (!sim::sample_due(world.steps(), world.dt(), record.rate)) continue;
    // One view for all: it costs a pass over the particles.
    if (!view) view = sim::terrain_view(world, heightfield::SurfaceKind::kMapped);
    stream->maker.update(*view);
    const planner::TerrainMap map = stream->maker.map();
    if (stream->bag) {
      const std::int64_t now = planner::ros::stamp(world.time());
      planner::ros::write_map(*stream->bag, map, stream->layers, now);
      planner::ros::write_machines(*stream->bag, world, now);
      continue;
    }
    const planner::Format& format = planner::format_named(record.format);
    char number[24];
    std::snprintf(number, sizeof number, "_%05llu",
                  static_cast<unsigned long long>(sim::sample_number(world.steps(), world.dt(), record.rate)));
    // All its files are the run's before they are there.
    const std::string stem = "maps/" + record.name + number;
    if (!format.extension.empty()) folder_.path(stem + format.extension);
    for (const std::string& end : format.others) folder_.path(stem + end);
    format.write(map, stream->layers, folder_.directory() + "/" + stem + format.extension);
  }
}

void MapRecorder::finish() {
  for (const auto& stream : streams_)
    if (stream->bag) stream->bag->close();
}

}  // namespace navvy::record
