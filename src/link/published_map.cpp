// SPDX-License-Identifier: Apache-2.0
#include "link/published_map.h"

#include "core/error.h"
#include "core/log.h"
#include "map/map_sources.h"
#include "sim/timing.h"
#include "sim/world_terrain.h"

namespace navvy::link {

namespace {

// An empty list stands for the default layers.
std::vector<map::MapLayer> layers_of(const PublishOptions& options) {
  return options.layers.empty() ? map::default_layers() : map::layers_named(options.layers);
}

}  // namespace

void require_publishable(const PublishOptions& options) {
  if (options.place.empty()) return;
  layers_of(options);
  link::MapPublisher::require_place(options.place);
}

PublishedMap::PublishedMap(const PublishOptions& options, const session::Session& session)
    : world_(session.world()),
      rate_(options.rate),
      layers_(layers_of(options)),
      feed_(map::options_for(world_.description(), world_.ground(), layers_, session.design())) {
  publisher_.emplace(feed_, options.place, layers_);
  if (publisher_->port() != 0) log_info("maps on port " + std::to_string(publisher_->port()));
  publish();
}

void PublishedMap::publish() {
  feed_.publish(sim::terrain_view(world_, heightfield::SurfaceKind::kMapped));
}

void PublishedMap::check() const {
  if (const std::string fault = publisher_->fault(); !fault.empty()) throw FileError(fault);
}

void PublishedMap::observe() {
  if (!sim::sample_due(world_.steps(), world_.dt(), rate_)) return;
  publish();
  check();
}

// Readers see the new state at once and not only at the next moment of the rate.
void PublishedMap::restart() {
  feed_.restart();
  publish();
  check();
}

void PublishedMap::finish() {
  // The end may fall between two moments of the rate.
  publish();
  publisher_->finish();
  check();
}

}  // namespace navvy::link
