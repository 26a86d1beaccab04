// SPDX-License-Identifier: Apache-2.0
#include "link/tcp_server.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <charconv>
#include <chrono>
#include <cstdint>
#include <cstring>
#include <list>
#include <system_error>
#include <thread>
#include <utility>

#include "core/error.h"
#include "core/log.h"
#include "core/stopwatch.h"

namespace navvy::link {
namespace {

[[noreturn]] void refuse(const std::string& option, const std::string& address,
                         const std::string& rule, const std::string& remedy) {
  throw InputError(Fault{Fault::Severity::kError, "", 0, option, address, rule, remedy});
}

/// Parses "tcp:5005" or "tcp:0.0.0.0:5005".
sockaddr_in parsed(const std::string& option, const std::string& address) {
  if (!TcpServer::is_address(address))
    refuse(option, address, "is not an address", "tcp:PORT or tcp:HOST:PORT");
  std::string host = "127.0.0.1", port = address.substr(4);
  if (const std::size_t colon = port.rfind(':'); colon != std::string::npos) {
    host = port.substr(0, colon);
    port = port.substr(colon + 1);
  }
  sockaddr_in out{};
  out.sin_family = AF_INET;
  unsigned number = 0;
  const auto [end, failed] = std::from_chars(port.data(), port.data() + port.size(), number);
  if (port.empty() || failed != std::errc() || end != port.data() + port.size() || number > 65535)
    refuse(option, address, "is not a port from 0 to 65535", "e.g. tcp:5005");
  if (inet_pton(AF_INET, host.c_str(), &out.sin_addr) != 1)
    refuse(option, address, "is not a numeric IPv4 address",
           "e.g. tcp:0.0.0.0:5005 for every interface");
  out.sin_port = htons(static_cast<std::uint16_t>(number));
  return out;
}

/// Opens a socket that listens, and writes its port to `port`.
int listening(const std::string& option, const std::string& address, int& port) {
  sockaddr_in at = parsed(option, address);
  const int file = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  const int yes = 1;
  if (file >= 0) ::setsockopt(file, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
  if (file < 0 || ::bind(file, reinterpret_cast<const sockaddr*>(&at), sizeof at) != 0 ||
      ::listen(file, 16) != 0) {
    const int code = errno;
    if (file >= 0) ::close(file);
    refuse(option, address, std::string("cannot listen there: ") + std::strerror(code),
           "choose another port, or 0 for a free one");
  }
  socklen_t length = sizeof at;
  ::getsockname(file, reinterpret_cast<sockaddr*>(&at), &length);
  port = ntohs(at.sin_port);
  return file;
}

/// Sends what is written at once, and notices a reader whose machine disappeared without closing,
/// after about a minute.
void prepare(int file) {
  const int yes = 1, idle = 30, every = 10, times = 3;
  ::setsockopt(file, IPPROTO_TCP, TCP_NODELAY, &yes, sizeof yes);
  ::setsockopt(file, SOL_SOCKET, SO_KEEPALIVE, &yes, sizeof yes);
  ::setsockopt(file, IPPROTO_TCP, TCP_KEEPIDLE, &idle, sizeof idle);
  ::setsockopt(file, IPPROTO_TCP, TCP_KEEPINTVL, &every, sizeof every);
  ::setsockopt(file, IPPROTO_TCP, TCP_KEEPCNT, &times, sizeof times);
}

}  // namespace

TcpReader::TcpReader(const TcpServer& server, int file) : server_(server), file_(file) {}

bool TcpReader::send(const char* bytes, std::size_t count) {
  Stopwatch lap;
  for (std::size_t at = 0; at < count;) {
    pollfd out{file_, POLLOUT, 0};
    const int ready = ::poll(&out, 1, static_cast<int>(1000 * TcpServer::kGlance));
    // While the run goes on a reader may take as long as it wants.
    waited_ = server_.closing() ? waited_ + lap.seconds() : 0;
    lap.restart();
    if (waited_ > TcpServer::kPatience) return false;
    if (ready <= 0) continue;
    const ssize_t sent = ::send(file_, bytes + at, count - at, MSG_NOSIGNAL | MSG_DONTWAIT);
    if (sent < 0 && (errno == EINTR || errno == EAGAIN)) continue;
    if (sent < 0) return false;
    at += static_cast<std::size_t>(sent);
  }
  return true;
}

bool TcpReader::is_there() const {
  pollfd ask{file_, POLLRDHUP, 0};
  return ::poll(&ask, 1, 0) <= 0;
}

struct TcpServer::State {
  std::string name;
  Serve serve;
  int listener = -1, port = 0;
  std::atomic<bool> closing{false};
  struct Reader {
    std::thread thread;
    std::atomic<bool> done{false};
  };
  // Used by the accepting thread, and after its end by the thread that joined it.
  std::list<Reader> readers;
  std::thread main;

  void accept_readers(const TcpServer& server);
  /// Starts the thread of a reader that has connected. @throws std::system_error if there is none.
  void start(const TcpServer& server, int file);
  /// Joins the threads of readers that are gone.
  void sweep();
};

// Runs in the accepting thread, so that no reader joins itself.
void TcpServer::State::sweep() {
  readers.remove_if([](Reader& reader) {
    if (!reader.done) return false;
    reader.thread.join();
    return true;
  });
}

void TcpServer::State::start(const TcpServer& server, int file) {
  Reader& reader = readers.emplace_back();
  const auto run = [this, &server, file, &reader] {
    prepare(file);
    try {
      TcpReader connection(server, file);
      serve(connection);
    } catch (const std::exception&) {
      // There is no memory for what it gets: the reader is dropped and may connect again.
    }
    ::close(file);
    reader.done = true;
  };
  try {
    reader.thread = std::thread(run);
  } catch (const std::system_error&) {
    readers.pop_back();
    throw;
  }
}

// Poll with a timeout, because closing the listener from another thread would not interrupt
// `accept`.
void TcpServer::State::accept_readers(const TcpServer& server) {
  // Logged once until a reader is accepted again: one that retries for ever would fill the log.
  bool warned = false;
  const auto warn_once = [&warned](const std::string& what) {
    if (!std::exchange(warned, true)) log_warning(what);
  };
  while (!closing) {
    pollfd in{listener, POLLIN, 0};
    const int ready = ::poll(&in, 1, static_cast<int>(1000 * kGlance));
    sweep();
    if (ready <= 0) continue;
    const int file = ::accept4(listener, nullptr, nullptr, SOCK_CLOEXEC);
    if (file < 0) {
      if (errno == EINTR || errno == EAGAIN || errno == ECONNABORTED) continue;
      warn_once(name + " cannot be accepted: " + std::strerror(errno));
      // The connection stays in the queue, and the next poll would find it at once.
      std::this_thread::sleep_for(std::chrono::duration<double>(kGlance));
      continue;
    }
    if (readers.size() >= kMostReaders) {
      warn_once(name + " was refused: " + std::to_string(kMostReaders) + " are connected");
      ::close(file);
      continue;
    }
    try {
      start(server, file);
      warned = false;
    } catch (const std::system_error& error) {
      ::close(file);
      warn_once(name + " cannot be accepted: " + error.what());
    }
  }
}

TcpServer::TcpServer(const std::string& option, const std::string& address, std::string reader,
                     Serve serve)
    : state_(std::make_unique<State>()) {
  state_->name = std::move(reader);
  state_->serve = std::move(serve);
  state_->listener = listening(option, address, state_->port);
  state_->main = std::thread([this] { state_->accept_readers(*this); });
}

TcpServer::~TcpServer() { close(); }

bool TcpServer::is_address(const std::string& place) { return place.rfind("tcp:", 0) == 0; }

void TcpServer::require_address(const std::string& option, const std::string& address) {
  int port = 0;
  // The port is released again. Another process could take it before the server starts, which its
  // constructor then reports.
  ::close(listening(option, address, port));
}

void TcpServer::close() {
  State& s = *state_;
  s.closing = true;
  if (s.main.joinable()) s.main.join();
  for (State::Reader& reader : s.readers) reader.thread.join();
  s.readers.clear();
  if (s.listener >= 0) ::close(std::exchange(s.listener, -1));
}

bool TcpServer::closing() const { return state_->closing; }

int TcpServer::port() const { return state_->port; }

}  // namespace navvy::link
