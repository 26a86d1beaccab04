// SPDX-License-Identifier: Apache-2.0
#include "link/map_publisher.h"

#include <cstdio>
#include <filesystem>
#include <memory>
#include <mutex>
#include <system_error>
#include <thread>
#include <utility>

#include "core/error.h"
#include "core/file.h"
#include "formats/map_patch.h"
#include "formats/part_file.h"
#include "link/tcp_server.h"

namespace navvy::link {
namespace {

namespace fs = std::filesystem;

/// Option that names the destination.
constexpr const char* kOption = "--publish";

[[noreturn]] void refuse(const std::string& place, const std::string& rule,
                         const std::string& remedy) {
  throw InputError(Fault{Fault::Severity::kError, "", 0, kOption, place, rule, remedy});
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

}  // namespace

struct MapPublisher::State {
  State(map::UpdateFeed& f, std::vector<map::MapLayer> l) : feed(f), layers(std::move(l)) {}

  map::UpdateFeed& feed;
  std::vector<map::MapLayer> layers;
  // Protects `fault`.
  mutable std::mutex mutex;
  std::string fault;
  // Either a server, or a folder and the thread that writes to it.
  std::unique_ptr<TcpServer> server;
  std::string folder;
  std::thread writer;

  void serve_files();
  void serve(TcpReader& reader) const;
  /// Writes a patch piece by piece; the file is complete or absent. @throws FileError.
  void write_patch(const std::string& path, const map::MapUpdate& update) const;
  /// Delivers updates one after the other until the feed is closed and nothing is left. `deliver`
  /// returns false to end it, and so does `alive`, which is called while there is nothing to
  /// deliver.
  template <class Deliver, class Alive>
  void follow(const Deliver& deliver, const Alive& alive) const;
};

template <class Deliver, class Alive>
void MapPublisher::State::follow(const Deliver& deliver, const Alive& alive) const {
  for (std::uint64_t seen = 0;;) {
    // Checked before the wait, so that updates published before the end still go out.
    const bool last = feed.closed();
    const map::UpdateFeed::Update update = feed.wait(seen, TcpServer::kGlance);
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

// A reader that connects starts from map number 0 and so gets a whole map first.
void MapPublisher::State::serve(TcpReader& reader) const {
  const formats::PatchSink sink = [&](const char* bytes, std::size_t count) {
    return reader.send(bytes, count);
  };
  follow([&](const map::MapUpdate& update) { return formats::send_patch(update, layers, sink); },
         [&] { return reader.is_there(); });
}

MapPublisher::MapPublisher(map::UpdateFeed& feed, const std::string& place,
                           std::vector<map::MapLayer> layers)
    : state_(std::make_unique<State>(feed, std::move(layers))) {
  State& s = *state_;
  if (TcpServer::is_address(place)) {
    s.server = std::make_unique<TcpServer>(kOption, place, "a reader of the map",
                                           [&s](TcpReader& reader) { s.serve(reader); });
    return;
  }
  require_folder(place);
  s.folder = place;
  std::error_code failed;
  fs::create_directories(place, failed);
  if (failed) throw FileError("cannot make '" + place + "': " + failed.message());
  s.writer = std::thread([&s] { s.serve_files(); });
}

MapPublisher::~MapPublisher() { finish(); }

void MapPublisher::require_place(const std::string& place) {
  if (TcpServer::is_address(place))
    TcpServer::require_address(kOption, place);
  else
    require_folder(place);
}

// The feed is closed first: the threads deliver what is left and end by themselves.
void MapPublisher::finish() {
  State& s = *state_;
  s.feed.close();
  if (s.server) s.server->close();
  if (s.writer.joinable()) s.writer.join();
}

int MapPublisher::port() const { return state_->server ? state_->server->port() : 0; }

std::string MapPublisher::fault() const {
  const std::lock_guard<std::mutex> lock(state_->mutex);
  return state_->fault;
}

}  // namespace navvy::link
