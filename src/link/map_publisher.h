// SPDX-License-Identifier: Apache-2.0
// Patches of a running map for other processes: over TCP, or as numbered files.
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "map/update_feed.h"

namespace navvy::link {

/// Sends every update of a feed to whoever reads, from threads of its own: the loop that publishes
/// never waits.
///
/// `tcp:PORT` listens on 127.0.0.1 (`tcp:HOST:PORT` on the address HOST; port 0: a free one): each
/// reader that connects gets one patch with the whole map, then patches in order, each from the
/// number of the one before. A slow reader gets one patch for all that it missed; one that goes
/// away, or shuts its own direction, is let go within a second and may come back. The 65th at a
/// time is turned away, which is logged. A folder gets `patch_000000001.navvymap` and so on, each
/// whole or not there, the first the whole map, to be read in the order of their numbers, and last
/// an empty file `end`.
class MapPublisher {
 public:
  /// @throws InputError for a place that is none, or a port that is taken; FileError for a folder
  /// that cannot be made.
  MapPublisher(map::UpdateFeed& feed, const std::string& place, std::vector<map::MapLayer> layers);
  /// As `finish`.
  ~MapPublisher();
  /// Whether one could publish there: makes no folder and keeps no port. @throws InputError as the
  /// constructor does.
  static void require_place(const std::string& place);
  MapPublisher(const MapPublisher&) = delete;
  MapPublisher& operator=(const MapPublisher&) = delete;

  /// Closes the feed, sends what is left, at most kPatience seconds to each reader, and ends its
  /// threads; what went wrong until then `fault` tells. Once.
  void finish();

  /// That it listens on; 0 for a folder.
  int port() const;
  /// What ended a folder's writing; empty while nothing did. Readers over TCP that go away are no
  /// fault.
  std::string fault() const;

  static constexpr double kPatience = 2;           ///< [s]
  static constexpr std::size_t kMostReaders = 64;  ///< over TCP, at a time
  /// File of a folder to which no more patches come.
  static constexpr const char* kEnd = "end";

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace navvy::link
