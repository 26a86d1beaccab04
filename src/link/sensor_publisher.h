// SPDX-License-Identifier: Apache-2.0
// Sends the readings of sensors to other processes over TCP while the simulation goes on.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "sim/world.h"

namespace navvy::link {

/// Sends each new value of all arrays of a world to all readers. It uses threads of its own, so the
/// simulation never waits for readers; without readers it copies nothing.
///
/// A reader gets lines of JSON (docs/reference/control_protocol.md, section "Readings over TCP").
/// The first one describes all arrays. Then follow the values that are delivered from then on, each
/// as a line with its stamps and `bytes`, and that many bytes behind the line. A reader that falls
/// more than kMostBytes behind misses the oldest values; a line gives their number. The last line
/// is {"end": true}; a stream that ends without it was cut off.
class SensorPublisher {
 public:
  /// Starts to listen at `address` (TcpServer). The world must outlive this object.
  /// @throws InputError for an invalid address or a port in use.
  SensorPublisher(const sim::World& world, const std::string& address);
  /// Ends publishing as `finish` does.
  ~SensorPublisher();
  /// Checks that the publisher could listen at `address`. @throws InputError as the constructor.
  static void require_address(const std::string& address);
  SensorPublisher(const SensorPublisher&) = delete;
  SensorPublisher& operator=(const SensorPublisher&) = delete;

  /// Hands on all values that arrays got since the last call. Must be called after each step.
  void publish();
  /// Reports to readers that the state was replaced, by the line {"restarted": TIME}. Must be
  /// called after a reset or load.
  void restart();
  /// Sends what is left and ends the threads. Each reader gets at most TcpServer::kPatience seconds
  /// for this. Later calls do nothing.
  void finish();
  /// Returns the port on which readers can connect.
  int port() const;

  /// Maximum size of the values kept for slow readers [bytes].
  static constexpr std::size_t kMostBytes = std::size_t{64} << 20;

 private:
  /// Server and the values for its readers.
  struct State;

  /// World whose arrays are published.
  const sim::World& world_;
  /// Sequence number of the last value of each array that was handed on.
  std::vector<std::uint64_t> seen_;
  /// Server and the values for its readers; never null.
  std::unique_ptr<State> state_;
};

}  // namespace navvy::link
