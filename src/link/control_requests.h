// SPDX-License-Identifier: Apache-2.0
// What a controller may ask between two steps: maps, arrays, pictures, states.
#pragma once

#include <cstdint>
#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "map/update_feed.h"
#include "run/simulation.h"

namespace navvy::link {

/// Returns enough of a value or text to recognise it, for messages: at most 80 bytes and "...".
std::string shown(const nlohmann::json& value);
std::string shown(const std::string& text);

/// Services that a program offers to its controller.
struct ControlServices {
  bool images = true;  ///< pictures may be drawn
  bool files = true;   ///< states may be saved to and loaded from files
};

/// Answers requests of a controller (docs/reference/control_protocol.md).
///
/// A request is an object with one key: {"info": true}, {"heights": {...}}, {"changed": N},
/// {"arrays": ["name"]} or {"arrays": true}, {"image": "camera"}, {"reset": true}, {"save":
/// "file"},
/// {"load": "file"} or {"watch": "machine/link"}. Simulated time stands still meanwhile. The map
/// begins with the construction, is updated when it is asked for, and costs nothing otherwise.
class ControlRequests {
 public:
  /// Keeps a reference to `simulation`, which must outlive this object. `rate` is the number of
  /// control steps per simulated second, for `info`.
  ControlRequests(run::Simulation& simulation, double rate, ControlServices services = {});

  /// Returns true if the line asks for something and so sets no input.
  static bool is_request(const nlohmann::json& line);
  /// Returns the answer, an object under the request's key. @throws Error for a request that cannot
  /// be answered; the simulation is then as it was.
  nlohmann::json answer(const nlohmann::json& line);
  /// Returns true if the last answer replaced the state: its outputs are others now.
  bool moved() const { return moved_; }

 private:
  // Answers by request, without the key.
  nlohmann::json dispatch(const std::string& key, const nlohmann::json& what);
  // One function per request. Each receives the value of its key and returns that of the answer.
  nlohmann::json heights(const nlohmann::json& what);
  nlohmann::json changed(const nlohmann::json& what);
  nlohmann::json arrays(const nlohmann::json& what) const;
  nlohmann::json image(const nlohmann::json& what) const;
  nlohmann::json info() const;
  nlohmann::json watch(const nlohmann::json& what);
  nlohmann::json save(const nlohmann::json& what) const;
  nlohmann::json replaced(const std::function<void()>& load);
  map::UpdateFeed::Update now();

  run::Simulation& simulation_;
  double rate_;  ///< control steps per simulated second
  ControlServices services_;
  /// Numbered maps of all layers.
  map::UpdateFeed feed_;
  bool moved_ = false;  ///< the last answer replaced the state
};

}  // namespace navvy::link
