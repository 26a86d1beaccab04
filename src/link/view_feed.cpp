// SPDX-License-Identifier: Apache-2.0
#include "link/view_feed.h"

#include <chrono>
#include <cstddef>
#include <nlohmann/json.hpp>
#include <span>
#include <utility>

#include "core/base64.h"

namespace navvy::link {
namespace {

using nlohmann::json;

constexpr std::size_t kTile = 2 + 16 * 16;  // numbers of a tile: its place and its heights

}  // namespace

void ViewFeed::add(const json& frame, const std::vector<std::int16_t>& tiles) {
  // Text is made outside of the lock. It begins with a brace, which `wait` puts back.
  auto text = std::make_shared<const std::string>(
      frame.dump(-1, ' ', false, json::error_handler_t::replace).substr(1));
  const std::lock_guard<std::mutex> lock(mutex_);
  if (end_) return;
  frame_ = std::move(text);
  ++number_;
  for (std::size_t i = 0; i + kTile <= tiles.size(); i += kTile) {
    Tile& tile = tiles_[{tiles[i + 1], tiles[i]}];
    tile.number = number_;
    const auto begin = tiles.begin() + static_cast<std::ptrdiff_t>(i);
    tile.values.assign(begin, begin + static_cast<std::ptrdiff_t>(kTile));
  }
  changed_.notify_all();
}

std::optional<ViewFeed::Update> ViewFeed::wait(std::uint64_t seen, double patience) {
  std::vector<std::int16_t> tiles;
  std::uint64_t number = 0;
  std::shared_ptr<const std::string> frame;
  {
    std::unique_lock<std::mutex> lock(mutex_);
    changed_.wait_for(lock, std::chrono::duration<double>(patience),
                      [&] { return number_ > seen || end_.has_value(); });
    if (number_ <= seen) return std::nullopt;
    number = number_;
    frame = frame_;
    for (const auto& [place, tile] : tiles_)
      if (tile.number > seen) tiles.insert(tiles.end(), tile.values.begin(), tile.values.end());
  }
  // The writer does not wait while text is made.
  const std::string missed = std::to_string(seen == 0 ? 0 : number - seen - 1);
  return Update{number, "{\"number\":" + std::to_string(number) + ",\"missed\":" + missed +
                            ",\"tiles\":\"" + base64(std::as_bytes(std::span(tiles))) + "\"," +
                            *frame};
}

void ViewFeed::close(const std::string& reason) {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (!end_) end_ = reason;
  changed_.notify_all();
}

std::optional<std::string> ViewFeed::end() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return end_;
}

void ViewFeed::wait_until_left(double patience) {
  std::unique_lock<std::mutex> lock(mutex_);
  changed_.wait_for(lock, std::chrono::duration<double>(patience),
                    [&] { return subscribers_ == 0; });
}

std::shared_ptr<void> ViewFeed::subscribe() {
  const std::lock_guard<std::mutex> lock(mutex_);
  ++subscribers_;
  ++subscriptions_;
  return {this, [](ViewFeed* feed) {
            const std::lock_guard<std::mutex> leaving(feed->mutex_);
            --feed->subscribers_;
            feed->changed_.notify_all();
          }};
}

int ViewFeed::subscribers() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return subscribers_;
}

std::uint64_t ViewFeed::subscriptions() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return subscriptions_;
}

}  // namespace navvy::link
