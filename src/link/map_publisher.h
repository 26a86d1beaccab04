// SPDX-License-Identifier: Apache-2.0
// Sends patches of a running map to other processes, over TCP or as numbered files.
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "map/update_feed.h"

namespace navvy::link {

/// Sends every update of a feed to all readers from threads of its own, so that the publishing loop
/// never waits.
///
/// `tcp:PORT` listens on 127.0.0.1, `tcp:HOST:PORT` on the address HOST; port 0 takes a free one.
/// Each reader that connects gets one patch with the whole map, then patches in order, each counted
/// from the one before. A slow reader gets one patch for everything it missed. A reader that
/// disconnects, or closes its own direction, is dropped within a second and may connect again. The
/// 65th reader at a time is refused, which is logged.
///
/// A folder gets `patch_000000001.navvymap` and so on, each complete or absent, the first with the
/// whole map, to be read in the order of their numbers, and at the end an empty file `end`.
class MapPublisher {
 public:
  /// Starts to publish. The feed must outlive it.
  /// @throws InputError for an invalid place or a port in use; FileError for a folder that cannot
  /// be made.
  MapPublisher(map::UpdateFeed& feed, const std::string& place, std::vector<map::MapLayer> layers);
  /// Finishes as `finish` does.
  ~MapPublisher();
  /// Checks that one could publish there, without making a folder or keeping a port. @throws
  /// InputError as the constructor.
  static void require_place(const std::string& place);
  MapPublisher(const MapPublisher&) = delete;
  MapPublisher& operator=(const MapPublisher&) = delete;

  /// Closes the feed, sends what is left, for at most kPatience seconds to each reader, and ends
  /// the threads. `fault` then reports what went wrong. Must be called at most once.
  void finish();

  /// Returns the port that it listens on; 0 for a folder.
  int port() const;
  /// Returns the cause that ended the writing of a folder; empty while there is none. Readers over
  /// TCP that disconnect are not a fault.
  std::string fault() const;

  /// Longest time that `finish` waits for a reader [s].
  static constexpr double kPatience = 2;
  /// Largest number of readers over TCP at a time.
  static constexpr std::size_t kMostReaders = 64;
  /// File of a folder that gets no more patches.
  static constexpr const char* kEnd = "end";

 private:
  /// Hides sockets and threads from clients.
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace navvy::link
