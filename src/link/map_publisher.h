// SPDX-License-Identifier: Apache-2.0
// Sends map updates of a running simulation to other processes, over TCP or as numbered files.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "map/update_feed.h"

namespace navvy::link {

/// Sends every update of a map feed to all readers as patches (formats/map_patch.h). It uses
/// threads of its own, so the thread that publishes updates never waits for readers.
///
/// The destination `tcp:PORT` or `tcp:HOST:PORT` is the address of a TcpServer. Each reader that
/// connects gets a patch with the whole map first, and then patches that each continue the one
/// before. A slow reader gets one patch for all updates that it missed. A reader that disconnects,
/// or closes its sending direction, is dropped within a second and may connect again.
///
/// Any other destination is a folder. It gets the files `patch_000000001.navvymap`,
/// `patch_000000002.navvymap` and so on, to be read in this order. The first one contains the whole
/// map. A file appears only when it is complete. The empty file `end` follows after the last one.
class MapPublisher {
 public:
  /// Starts to publish `layers` of the maps in `feed`, which must outlive this object, to the
  /// destination `place`.
  /// @throws InputError for an invalid destination or a port in use; FileError for a folder that
  /// cannot be made.
  MapPublisher(map::UpdateFeed& feed, const std::string& place, std::vector<map::MapLayer> layers);
  /// Ends publishing as `finish` does.
  ~MapPublisher();
  /// Checks that the destination `place` can be used, without making a folder or keeping a port
  /// open. @throws InputError as the constructor.
  static void require_place(const std::string& place);
  MapPublisher(const MapPublisher&) = delete;
  MapPublisher& operator=(const MapPublisher&) = delete;

  /// Closes the feed, sends the remaining updates, and ends the threads. Each TCP reader gets at
  /// most TcpServer::kPatience seconds for this. Later calls do nothing. After this call, `fault`
  /// is final.
  void finish();

  /// Returns the port on which readers can connect; 0 if the destination is a folder.
  int port() const;
  /// Returns the message of the first error that occurred when writing to a folder; empty if there
  /// was none. TCP readers that disconnect are not an error.
  std::string fault() const;

  /// Name of the file that marks the end of the patches in a folder.
  static constexpr const char* kEnd = "end";

 private:
  /// Server or thread of the publisher.
  struct State;
  /// Server or thread of the publisher; never null.
  std::unique_ptr<State> state_;
};

}  // namespace navvy::link
