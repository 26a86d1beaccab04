// SPDX-License-Identifier: Apache-2.0
// A run's map for other processes: what `navvy run --publish` asks for.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "link/map_publisher.h"
#include "session/session.h"

namespace navvy::link {

/// What the command line says of it.
struct PublishOptions {
  std::string place;   ///< as link::MapPublisher takes it; empty: nothing is published
  std::string layers;  ///< names separated by commas; empty: all
  double rate = 10;    ///< updates per simulated second
};

/// Asks, before anything of an earlier run is touched, what a PublishedMap would fail at.
/// @throws InputError for layers or a place that are none, or a place that is taken.
void require_publishable(const PublishOptions& options);

/// Publishes the map of a session as often as asked for, from its making on, and that of its end.
class PublishedMap {
 public:
  /// The session must outlive it. @throws InputError for layers or a place that are none, FileError
  /// as the MapPublisher.
  PublishedMap(const PublishOptions& options, const session::Session& session);
  /// Called after each step. @throws FileError for what ended the writing.
  void observe();
  /// Called when the session was put into another state: readers get it at once, as a whole map.
  /// @throws as `observe`.
  void restart();
  /// Publishes the state of the end, waits until readers have it (MapPublisher::finish) and ends.
  /// Nothing is published after it. @throws FileError for a patch that could not be written.
  void finish();

 private:
  void publish();
  void check() const;

  const sim::World& world_;
  double rate_;
  std::vector<map::MapLayer> layers_;
  map::UpdateFeed feed_;
  std::optional<link::MapPublisher> publisher_;
};

}  // namespace navvy::link
