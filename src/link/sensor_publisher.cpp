// SPDX-License-Identifier: Apache-2.0
#include "link/sensor_publisher.h"

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <deque>
#include <mutex>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "link/array_header.h"
#include "link/tcp_server.h"

namespace navvy::link {

using nlohmann::json;

namespace {

/// Option that names the address.
constexpr const char* kOption = "--publish-sensors";

std::string line_of(const json& out) {
  return out.dump(-1, ' ', false, json::error_handler_t::replace) + "\n";
}

/// Parts of the stream in their order, numbered from 0, as long as they are kept for slow readers.
class Stream {
 public:
  using Part = std::shared_ptr<const std::string>;

  /// Adds a part and drops the oldest ones if there are too many bytes.
  void add(std::string text) {
    Part part = std::make_shared<const std::string>(std::move(text));
    const std::lock_guard<std::mutex> lock(mutex_);
    bytes_ += part->size();
    parts_.push_back(std::move(part));
    // The newest one stays, however large it is.
    while (bytes_ > SensorPublisher::kMostBytes && parts_.size() > 1) {
      bytes_ -= parts_.front()->size();
      parts_.pop_front();
      ++first_;
    }
    added_.notify_all();
  }
  /// Returns the number that the next part will get.
  std::uint64_t end() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return first_ + parts_.size();
  }
  /// Waits a moment for the part `number`, or the oldest one kept after it. Returns it with its
  /// number, or null if there is none yet.
  std::pair<Part, std::uint64_t> wait(std::uint64_t number) {
    std::unique_lock<std::mutex> lock(mutex_);
    added_.wait_for(lock, std::chrono::duration<double>(TcpServer::kGlance),
                    [&] { return first_ + parts_.size() > number || closed_; });
    number = std::max(number, first_);
    if (number >= first_ + parts_.size()) return {nullptr, number};
    return {parts_[static_cast<std::size_t>(number - first_)], number};
  }
  /// Declares that no part follows.
  void close() {
    const std::lock_guard<std::mutex> lock(mutex_);
    closed_ = true;
    added_.notify_all();
  }
  bool closed() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return closed_;
  }

 private:
  mutable std::mutex mutex_;
  std::condition_variable added_;
  std::deque<Part> parts_;
  std::uint64_t first_ = 0;
  std::size_t bytes_ = 0;
  bool closed_ = false;
};

}  // namespace

struct SensorPublisher::State {
  // First line of each reader.
  std::string arrays;
  Stream stream;
  std::atomic<int> readers{0};
  std::optional<TcpServer> server;

  void serve(TcpReader& reader);
  bool send(TcpReader& reader, const std::string& text) const {
    return reader.send(text.data(), text.size());
  }
  /// Sends parts until the stream is closed and nothing is left, or the reader is gone.
  void follow(TcpReader& reader, std::uint64_t next);
};

void SensorPublisher::State::serve(TcpReader& reader) {
  // Counted before the place in the stream is taken, so that no value between both is missing.
  ++readers;
  try {
    const std::uint64_t next = stream.end();
    if (send(reader, arrays)) follow(reader, next);
  } catch (...) {
    --readers;
    throw;
  }
  --readers;
}

void SensorPublisher::State::follow(TcpReader& reader, std::uint64_t next) {
  for (;;) {
    // Asked before the wait, so that parts added before the end still go out.
    const bool last = stream.closed();
    const auto [part, number] = stream.wait(next);
    if (part == nullptr) {
      if (last) send(reader, line_of({{"end", true}}));
      if (last || !reader.is_there()) return;
      continue;
    }
    if (number > next && !send(reader, line_of({{"missed", number - next}}))) return;
    if (!send(reader, *part)) return;
    next = number + 1;
  }
}

SensorPublisher::SensorPublisher(const sim::World& world, const std::string& address)
    : world_(world), state_(std::make_unique<State>()) {
  json arrays = json::array();
  for (const sim::ArrayChannel& channel : world_.arrays().channels()) {
    arrays.push_back(array_description(channel));
    arrays.back()["name"] = channel.name;
    seen_.push_back(world_.arrays().view(static_cast<int>(seen_.size())).sequence());
  }
  state_->arrays = line_of({{"arrays", arrays}});
  state_->server.emplace(kOption, address, "a reader of the sensors",
                         [this](TcpReader& reader) { state_->serve(reader); });
}

SensorPublisher::~SensorPublisher() { finish(); }

void SensorPublisher::require_address(const std::string& address) {
  TcpServer::require_address(kOption, address);
}

void SensorPublisher::publish() {
  for (std::size_t i = 0; i < seen_.size(); ++i) {
    const sim::ArrayView view = world_.arrays().view(static_cast<int>(i));
    if (std::exchange(seen_[i], view.sequence()) == view.sequence() || state_->readers == 0)
      continue;
    json head = array_header(view);
    head["name"] = view.channel().name;
    head["bytes"] = view.bytes().size();
    std::string text = line_of(head);
    text.append(reinterpret_cast<const char*>(view.bytes().data()), view.bytes().size());
    state_->stream.add(std::move(text));
  }
}

// The values of the new state were delivered in its past, so they are not sent again.
void SensorPublisher::restart() {
  for (std::size_t i = 0; i < seen_.size(); ++i)
    seen_[i] = world_.arrays().view(static_cast<int>(i)).sequence();
  state_->stream.add(line_of({{"restarted", world_.time()}}));
}

void SensorPublisher::finish() {
  state_->stream.close();
  state_->server->close();
}

int SensorPublisher::port() const { return state_->server->port(); }

}  // namespace navvy::link
