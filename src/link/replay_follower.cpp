// SPDX-License-Identifier: Apache-2.0
#include "link/replay_follower.h"

#include <sys/stat.h>

#include <cstring>
#include <nlohmann/json.hpp>
#include <optional>
#include <tuple>
#include <utility>
#include <vector>

#include "core/base64.h"
#include "core/error.h"

namespace navvy::link {
namespace {

using nlohmann::json;

/// Length of a longest row that is read [bytes], as in pages of runs.
constexpr std::size_t kLongest = std::size_t{256} << 20;
/// Calls of `step` over which the rows that wait are spread: two seconds at ten calls per second.
constexpr std::size_t kCalls = 20;

/// Returns identity of a file; zeros if there is none.
std::pair<std::uint64_t, std::uint64_t> identity(const std::string& path) {
  struct stat about {};
  if (::stat(path.c_str(), &about) != 0) return {0, 0};
  return {about.st_dev, about.st_ino};
}

/// Returns the tiles of a row; nothing if they are damaged.
std::optional<std::vector<std::int16_t>> tiles_of(const json& row) {
  const auto text = row.find("tiles");
  if (text == row.end() || !text->is_string()) return std::nullopt;
  const auto bytes = base64_bytes(text->get_ref<const std::string&>());
  if (!bytes || bytes->size() % (2 * (2 + 16 * 16)) != 0) return std::nullopt;
  std::vector<std::int16_t> out(bytes->size() / 2);
  if (!out.empty()) std::memcpy(out.data(), bytes->data(), bytes->size());
  return out;
}

}  // namespace

ReplayFollower::ReplayFollower(const std::string& path) : path_(path) {
  in_.open(path, std::ios::binary);
  if (!in_) throw FileError("cannot read '" + path + "'");
  std::tie(device_, inode_) = identity(path);
  read();
  if (rows_.empty())
    throw InputError(Fault{Fault::Severity::kError, path, 1, "replay", "", "has no header yet",
                           "wait until the run has written it"});
  header_ = std::move(rows_.front());
  rows_.pop_front();
}

bool ReplayFollower::is_current() const { return identity(path_) == std::pair(device_, inode_); }

void ReplayFollower::read() {
  in_.clear();
  for (std::string part; std::getline(in_, part);) {
    unfinished_ += part;
    if (in_.eof()) break;
    if (unfinished_.size() <= kLongest) rows_.push_back(std::move(unfinished_));
    unfinished_.clear();
  }
}

void ReplayFollower::step(ViewFeed& feed, bool all) {
  read();
  std::size_t count = all ? rows_.size() : (rows_.size() + kCalls - 1) / kCalls;
  for (; count > 0; --count) {
    add(rows_.front(), feed);
    rows_.pop_front();
  }
}

void ReplayFollower::add(const std::string& text, ViewFeed& feed) {
  json row = json::parse(text, nullptr, false);
  if (!row.is_object() || !row.contains("poses")) return;
  const auto tiles = tiles_of(row);
  if (!tiles) return;
  row.erase("tiles");
  feed.add(row, *tiles);
}

}  // namespace navvy::link
