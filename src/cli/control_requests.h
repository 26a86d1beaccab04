// SPDX-License-Identifier: Apache-2.0
// What a controller may ask between two steps: maps, pictures, states (scenarios/README.md,
// "Driving it from another program").
#pragma once

#include <cstdint>
#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "map/update_feed.h"
#include "session/session.h"

namespace navvy::cli {

/// Enough of a value or text to recognise it, for messages: at most 80 bytes and "...".
std::string shown(const nlohmann::json& value);
std::string shown(const std::string& text);

/// A drawn picture as a PNG file's bytes.
struct Picture {
  int width = 0, height = 0;
  std::vector<char> png;
};

/// What the program lends to its controller.
struct ControlServices {
  /// Draws what a camera of the scene sees now; nothing: no pictures. @throws Error.
  std::function<Picture(const std::string& camera)> draw;
  bool files = true;  ///< states may be saved to and loaded from files
};

/// Answers one request a line: {"heights": {...}}, {"changed": N}, {"image": "camera"}, {"info":
/// true}, {"reset": true}, {"save": "file"}, {"load": "file"}, {"watch": "machine/link"}. Simulated
/// time stands still meanwhile; the map begins with the session, is brought up to date when it is
/// asked for and costs nothing otherwise.
class ControlRequests {
 public:
  /// Keeps the session's present state for `reset` (some MiB for each million particles).
  ControlRequests(session::Session& session, double rate, ControlServices services);

  /// Whether the line asks for something, and so drives nothing.
  static bool is_request(const nlohmann::json& line);
  /// The answer, an object under the request's key. @throws Error for what cannot be answered: the
  /// session is then as it was.
  nlohmann::json answer(const nlohmann::json& line);
  /// Whether the last answer put the session into another state: its outputs are others now.
  bool moved() const { return moved_; }

 private:
  nlohmann::json heights(const nlohmann::json& what);
  nlohmann::json changed(const nlohmann::json& what);
  nlohmann::json image(const nlohmann::json& what) const;
  nlohmann::json info() const;
  nlohmann::json go_back(const std::function<void()>& load);
  map::UpdateFeed::Update now();

  session::Session& session_;
  const sim::World& world_;
  double rate_;
  ControlServices services_;
  std::vector<char> start_;
  map::UpdateFeed feed_;
  bool moved_ = false;
};

}  // namespace navvy::cli
