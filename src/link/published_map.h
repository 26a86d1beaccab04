// SPDX-License-Identifier: Apache-2.0
// Publishes the map of a run to other processes, as `navvy run --publish` does.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "link/map_publisher.h"
#include "session/session.h"

namespace navvy::link {

/// Options of the command line for publishing a map.
struct PublishOptions {
  /// Destination as described at MapPublisher, such as "tcp:5005"; empty if no map is published.
  std::string place;
  /// Comma-separated names of the layers to publish; empty for the default layers.
  std::string layers;
  /// Number of updates per simulated second [1/s].
  double rate = 10;
};

/// Checks the options before a run starts, without changing any file.
/// @throws InputError for unknown layers, or for a destination that is invalid or in use.
void require_publishable(const PublishOptions& options);

/// Publishes the map of a session to other processes: at construction, at a fixed rate of simulated
/// time, and at the end of the run.
class PublishedMap {
 public:
  /// Publishes the first map. The session must outlive this object. @throws InputError for unknown
  /// layers or an invalid destination, FileError as MapPublisher.
  PublishedMap(const PublishOptions& options, const session::Session& session);
  /// Publishes an update if one is due. Must be called after each step. @throws FileError if
  /// writing to a folder failed, now or earlier.
  void observe();
  /// Publishes the current state as a new map. Must be called after the state of the session was
  /// replaced. @throws FileError as `observe`.
  void restart();
  /// Publishes the final state and waits until the readers have received it (MapPublisher::finish).
  /// Publishes nothing afterwards. @throws FileError as `observe`.
  void finish();

 private:
  /// Publishes the current state if it has changed.
  void publish();
  /// Checks that publishing works. @throws FileError if writing to a folder failed.
  void check() const;

  /// World whose terrain is published.
  const sim::World& world_;
  /// Number of updates per simulated second [1/s].
  double rate_;
  /// Layers that are sent to readers.
  std::vector<map::MapLayer> layers_;
  /// Numbered map updates of this run, from which the publisher sends.
  map::UpdateFeed feed_;
  /// Sends the updates of `feed_`. Always present after construction.
  std::optional<link::MapPublisher> publisher_;
};

}  // namespace navvy::link
