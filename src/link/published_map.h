// SPDX-License-Identifier: Apache-2.0
// The map of a run for other processes, as `navvy run --publish` asks for it.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "link/map_publisher.h"
#include "session/session.h"

namespace navvy::link {

/// Options of the command line.
struct PublishOptions {
  /// Place as MapPublisher takes it; empty: nothing is published.
  std::string place;
  /// Names separated by commas; empty: the default layers.
  std::string layers;
  /// Updates per simulated second [1/s].
  double rate = 10;
};

/// Checks the options before anything of an earlier run is touched.
/// @throws InputError for unknown layers, an invalid place or one that is in use.
void require_publishable(const PublishOptions& options);

/// Publishes the map of a session at its rate, from its construction on, and the map of the end.
class PublishedMap {
 public:
  /// The session must outlive it. @throws InputError for unknown layers or an invalid place,
  /// FileError as MapPublisher.
  PublishedMap(const PublishOptions& options, const session::Session& session);
  /// Publishes when an update is due. Must be called after each step. @throws FileError for what
  /// ended the writing.
  void observe();
  /// Publishes the new state at once, as a whole map. Must be called when the session was put into
  /// another state. @throws as `observe`.
  void restart();
  /// Publishes the final state, waits until readers have it (MapPublisher::finish) and ends.
  /// Nothing is published afterwards. @throws FileError for a patch that could not be written.
  void finish();

 private:
  /// Publishes the present state.
  void publish();
  /// @throws FileError for the fault of the publisher, if there is one.
  void check() const;

  const sim::World& world_;
  double rate_;
  std::vector<map::MapLayer> layers_;
  map::UpdateFeed feed_;
  std::optional<link::MapPublisher> publisher_;
};

}  // namespace navvy::link
