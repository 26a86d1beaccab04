// SPDX-License-Identifier: Apache-2.0
// Serves readers over TCP, each in a thread of its own, so that a slow one delays no other.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <string>

namespace navvy::link {

class TcpServer;

/// A connected reader, as its thread sees it.
class TcpReader {
 public:
  /// Takes the open socket `file` of a reader of `server`, which must outlive this object.
  TcpReader(const TcpServer& server, int file);
  TcpReader(const TcpReader&) = delete;
  TcpReader& operator=(const TcpReader&) = delete;

  /// Sends `count` bytes and waits for as long as the reader takes. Returns false if the reader has
  /// disconnected, or needed more than TcpServer::kPatience since the server began to close.
  bool send(const char* bytes, std::size_t count);
  /// Returns false if the reader has closed its sending direction.
  bool is_there() const;

 private:
  /// Server that the reader is connected to.
  const TcpServer& server_;
  /// Socket of the reader.
  int file_;
  /// Time that this reader took since the server began to close [s].
  double waited_ = 0;
};

/// Listens on a TCP address and calls a function for each reader that connects, in a thread of the
/// reader's own.
///
/// The address `tcp:PORT` listens on 127.0.0.1, and `tcp:HOST:PORT` on the IPv4 address HOST; port
/// 0 selects a free port. If kMostReaders are connected, further ones are refused, which is logged.
class TcpServer {
 public:
  /// Serves one reader and returns when the reader is gone or nothing is left to send. A
  /// std::exception from it drops the reader.
  using Serve = std::function<void(TcpReader&)>;

  /// Starts to listen at `address`.
  /// @param option name of the option that holds the address, for messages
  /// @param reader name of a reader in messages, such as "a reader of the map"
  /// @param serve function that is called in the thread of each reader
  /// @throws InputError for an invalid address or a port in use.
  TcpServer(const std::string& option, const std::string& address, std::string reader, Serve serve);
  /// Closes as `close` does.
  ~TcpServer();
  TcpServer(const TcpServer&) = delete;
  TcpServer& operator=(const TcpServer&) = delete;

  /// Returns true if `place` is meant as an address: it begins with "tcp:".
  static bool is_address(const std::string& place);
  /// Checks that a server could listen at `address`, without keeping the port open.
  /// @throws InputError as the constructor.
  static void require_address(const std::string& option, const std::string& address);

  /// Accepts no more readers, waits until the present ones have taken what is left, each at most
  /// kPatience seconds, and ends the threads. Later calls do nothing.
  void close();
  /// Returns true once `close` was called.
  bool closing() const;
  /// Returns the port on which readers can connect.
  int port() const;

  /// Interval at which a waiting thread checks whether it must end [s].
  static constexpr double kGlance = 0.2;
  /// Maximum time that `close` waits for a reader [s].
  static constexpr double kPatience = 2;
  /// Maximum number of readers connected at the same time.
  static constexpr std::size_t kMostReaders = 64;

 private:
  /// Sockets and threads of the server.
  struct State;
  /// Sockets and threads of the server; never null.
  std::unique_ptr<State> state_;
};

}  // namespace navvy::link
