// SPDX-License-Identifier: Apache-2.0
// One thread accepts readers, and each reader has a thread of its own, so that a slow reader delays
// no other.
#include "link/map_publisher.h"

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
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <list>
#include <mutex>
#include <system_error>
#include <thread>
#include <utility>

#include "core/error.h"
#include "core/file.h"
#include "core/log.h"
#include "core/stopwatch.h"
#include "formats/map_patch.h"
#include "formats/part_file.h"

namespace navvy::link {
namespace {

namespace fs = std::filesystem;

/// Interval at which a waiting thread checks whether it must end [s].
constexpr double kGlance = 0.2;

[[noreturn]] void refuse(const std::string& place, const std::string& rule,
                         const std::string& remedy) {
  throw InputError(Fault{Fault::Severity::kError, "", 0, "--publish", place, rule, remedy});
}

/// Parses "tcp:5005" or "tcp:0.0.0.0:5005".
sockaddr_in address_of(const std::string& place) {
  std::string host = "127.0.0.1", port = place.substr(4);
  if (const std::size_t colon = port.rfind(':'); colon != std::string::npos) {
    host = port.substr(0, colon);
    port = port.substr(colon + 1);
  }
  sockaddr_in out{};
  out.sin_family = AF_INET;
  unsigned number = 0;
  const auto [end, failed] = std::from_chars(port.data(), port.data() + port.size(), number);
  if (port.empty() || failed != std::errc() || end != port.data() + port.size() || number > 65535)
    refuse(place, "is not a port from 0 to 65535", "e.g. tcp:5005");
  if (inet_pton(AF_INET, host.c_str(), &out.sin_addr) != 1)
    refuse(place, "is not a numeric IPv4 address", "e.g. tcp:0.0.0.0:5005 for every interface");
  out.sin_port = htons(static_cast<std::uint16_t>(number));
  return out;
}

/// Opens a socket that listens, and writes its port to `port`.
int listening(const std::string& place, int& port) {
  sockaddr_in address = address_of(place);
  const int file = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  const int yes = 1;
  if (file >= 0) ::setsockopt(file, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
  if (file < 0 || ::bind(file, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0 ||
      ::listen(file, 16) != 0) {
    const int code = errno;
    if (file >= 0) ::close(file);
    refuse(place, std::string("cannot listen there: ") + std::strerror(code),
           "choose another port, or 0 for a free one");
  }
  socklen_t length = sizeof address;
  ::getsockname(file, reinterpret_cast<sockaddr*>(&address), &length);
  port = ntohs(address.sin_port);
  return file;
}

/// Checks that the folder is new or empty.
void require_folder(const std::string& place) {
  if (place.empty()) refuse(place, "does not name a folder", "a new folder, or tcp:PORT");
  // "udp:5005" is meant as an address; for a folder of that name users write "./udp:5005".
  const std::size_t colon = place.find(':');
  if (colon != std::string::npos && colon > 0 && place.find('/') == std::string::npos)
    refuse(place, "is not a known kind of address",
           "tcp:PORT or tcp:HOST:PORT; for a folder ./" + place);
  std::error_code failed;
  const fs::file_status there = fs::status(place, failed);
  if (!fs::exists(there)) return;
  if (!fs::is_directory(there)) refuse(place, "exists and is not a folder", "name a new folder");
  const fs::directory_iterator entries(place, failed);
  if (failed) refuse(place, "cannot be read: " + failed.message(), "name a new folder");
  if (entries != fs::directory_iterator())
    refuse(
        place,
        "holds '" + entries->path().filename().string() + "' already: patches are numbered from 1",
        "name a new folder");
}

bool is_address(const std::string& place) { return place.rfind("tcp:", 0) == 0; }

/// Makes the system notice a reader whose machine disappeared without closing, after about a
/// minute.
void watch_connection(int file) {
  const int yes = 1, idle = 30, every = 10, times = 3;
  ::setsockopt(file, SOL_SOCKET, SO_KEEPALIVE, &yes, sizeof yes);
  ::setsockopt(file, IPPROTO_TCP, TCP_KEEPIDLE, &idle, sizeof idle);
  ::setsockopt(file, IPPROTO_TCP, TCP_KEEPINTVL, &every, sizeof every);
  ::setsockopt(file, IPPROTO_TCP, TCP_KEEPCNT, &times, sizeof times);
}

/// Returns false when the other end has closed its direction.
bool is_there(int file) {
  pollfd ask{file, POLLRDHUP, 0};
  return ::poll(&ask, 1, 0) <= 0;
}

}  // namespace

struct MapPublisher::State {
  State(map::UpdateFeed& f, std::vector<map::MapLayer> l) : feed(f), layers(std::move(l)) {}

  map::UpdateFeed& feed;
  std::vector<map::MapLayer> layers;
  std::string folder;
  int listener = -1, port = 0;
  // Protects `fault`.
  mutable std::mutex mutex;
  std::string fault;
  struct Reader {
    std::thread thread;
    std::atomic<bool> done{false};
  };
  // Used by the accepting thread, and after its end by the thread that joined it.
  std::list<Reader> readers;
  std::thread main;

  void serve_files();
  void accept_readers();
  /// Joins the threads of readers that are gone.
  void sweep();
  void serve(int file, std::atomic<bool>& done);
  bool send_all(int file, const char* bytes, std::size_t count, double& waited) const;
  /// Writes a patch piece by piece; the file is complete or absent. @throws FileError.
  void write_patch(const std::string& path, const map::MapUpdate& update) const;
  /// Delivers updates one after the other until the feed is closed and nothing is left. `deliver`
  /// returns false to end it, and so does `alive`, which is called while there is nothing to
  /// deliver.
  template <class Deliver, class Alive>
  void follow(const Deliver& deliver, const Alive& alive);
};

template <class Deliver, class Alive>
void MapPublisher::State::follow(const Deliver& deliver, const Alive& alive) {
  for (std::uint64_t seen = 0;;) {
    // Checked before the wait, so that updates published before the end still go out.
    const bool last = feed.closed();
    const map::UpdateFeed::Update update = feed.wait(seen, kGlance);
    if (update != nullptr) {
      if (!deliver(*update)) return;
      seen = update->sequence;
    } else if (last || !alive()) {
      return;
    }
  }
}

// A folder that cannot be written ends the thread; the run reports the cause at its next update.
void MapPublisher::State::serve_files() {
  std::uint64_t number = 0;
  const auto attempt = [&](const auto& write) {
    try {
      write();
      return true;
    } catch (const std::exception& error) {
      const std::lock_guard<std::mutex> lock(mutex);
      // Users read the first cause.
      if (fault.empty()) fault = error.what();
      return false;
    }
  };
  follow(
      [&](const map::MapUpdate& update) {
        char name[40];
        std::snprintf(name, sizeof name, "patch_%09llu.navvymap",
                      static_cast<unsigned long long>(++number));
        return attempt([&] { write_patch((fs::path(folder) / name).string(), update); });
      },
      [] { return true; });
  // Written also after a fault, so that readers do not wait for ever.
  attempt([&] { write_file_atomically((fs::path(folder) / kEnd).string(), ""); });
}

// A reader never sees half a patch.
void MapPublisher::State::write_patch(const std::string& path, const map::MapUpdate& update) const {
  formats::PartFile file(path);
  formats::send_patch(update, layers, [&](const char* bytes, std::size_t count) {
    file.write(bytes, count);
    return true;
  });
  file.commit();
}

/// Returns false when the reader is gone, or too slow at the end. `waited` counts the time it took
/// since then [s].
bool MapPublisher::State::send_all(int file, const char* bytes, std::size_t count,
                                   double& waited) const {
  Stopwatch lap;
  for (std::size_t at = 0; at < count;) {
    pollfd out{file, POLLOUT, 0};
    const int ready = ::poll(&out, 1, static_cast<int>(1000 * kGlance));
    // While the run goes on a reader may take as long as it wants.
    waited = feed.closed() ? waited + lap.seconds() : 0;
    lap.restart();
    if (waited > kPatience) return false;
    if (ready <= 0) continue;
    const ssize_t sent = ::send(file, bytes + at, count - at, MSG_NOSIGNAL | MSG_DONTWAIT);
    if (sent < 0 && (errno == EINTR || errno == EAGAIN)) continue;
    if (sent < 0) return false;
    at += static_cast<std::size_t>(sent);
  }
  return true;
}

// A reader that connects starts from map number 0 and so gets a whole map first.
void MapPublisher::State::serve(int file, std::atomic<bool>& done) {
  const int yes = 1;
  ::setsockopt(file, IPPROTO_TCP, TCP_NODELAY, &yes, sizeof yes);
  watch_connection(file);
  try {
    double waited = 0;
    const formats::PatchSink sink = [&](const char* bytes, std::size_t count) {
      return send_all(file, bytes, count, waited);
    };
    follow([&](const map::MapUpdate& update) { return formats::send_patch(update, layers, sink); },
           [&] { return is_there(file); });
  } catch (const std::exception&) {
    // There is no memory for its patch: the reader is dropped and may connect again.
  }
  ::close(file);
  done = true;
}

// Runs in the accepting thread, so that no reader joins itself.
void MapPublisher::State::sweep() {
  readers.remove_if([](Reader& reader) {
    if (!reader.done) return false;
    reader.thread.join();
    return true;
  });
}

// Poll with a timeout, because closing the listener from another thread would not interrupt
// `accept`.
void MapPublisher::State::accept_readers() {
  // Logged once until a reader is accepted again: one that retries for ever would fill the log.
  bool warned = false;
  const auto warn_once = [&warned](const std::string& what) {
    if (!std::exchange(warned, true)) log_warning(what);
  };
  while (!feed.closed()) {
    pollfd in{listener, POLLIN, 0};
    const int ready = ::poll(&in, 1, static_cast<int>(1000 * kGlance));
    sweep();
    if (ready <= 0) continue;
    const int file = ::accept4(listener, nullptr, nullptr, SOCK_CLOEXEC);
    if (file < 0) {
      if (errno == EINTR || errno == EAGAIN || errno == ECONNABORTED) continue;
      warn_once(std::string("a reader of the map cannot be accepted: ") + std::strerror(errno));
      // The connection stays in the queue, and the next poll would find it at once.
      std::this_thread::sleep_for(std::chrono::duration<double>(kGlance));
      continue;
    }
    if (readers.size() >= kMostReaders) {
      warn_once("a reader of the map was refused: " + std::to_string(kMostReaders) +
                " are connected");
      ::close(file);
      continue;
    }
    Reader& reader = readers.emplace_back();
    try {
      reader.thread = std::thread([this, file, &reader] { serve(file, reader.done); });
      warned = false;
    } catch (const std::system_error& error) {
      readers.pop_back();
      ::close(file);
      warn_once(std::string("a reader of the map cannot be accepted: ") + error.what());
    }
  }
}

MapPublisher::MapPublisher(map::UpdateFeed& feed, const std::string& place,
                           std::vector<map::MapLayer> layers)
    : state_(std::make_unique<State>(feed, std::move(layers))) {
  State& s = *state_;
  if (is_address(place)) {
    s.listener = listening(place, s.port);
    s.main = std::thread([&s] { s.accept_readers(); });
    return;
  }
  require_folder(place);
  s.folder = place;
  std::error_code failed;
  fs::create_directories(place, failed);
  if (failed) throw FileError("cannot make '" + place + "': " + failed.message());
  s.main = std::thread([&s] { s.serve_files(); });
}

MapPublisher::~MapPublisher() { finish(); }

void MapPublisher::require_place(const std::string& place) {
  int port = 0;
  // The port is released again. Another process could take it before the publisher starts, which
  // its constructor then reports.
  if (is_address(place))
    ::close(listening(place, port));
  else
    require_folder(place);
}

// The feed is closed first: the threads deliver what is left and end by themselves.
void MapPublisher::finish() {
  State& s = *state_;
  s.feed.close();
  if (s.main.joinable()) s.main.join();
  for (State::Reader& reader : s.readers) reader.thread.join();
  s.readers.clear();
  if (s.listener >= 0) ::close(std::exchange(s.listener, -1));
}

int MapPublisher::port() const { return state_->port; }

std::string MapPublisher::fault() const {
  const std::lock_guard<std::mutex> lock(state_->mutex);
  return state_->fault;
}

}  // namespace navvy::link
