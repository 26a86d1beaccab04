// SPDX-License-Identifier: Apache-2.0
// Requests that a controller can make between two steps: maps, arrays, particles, pictures, states.
#pragma once

#include <cstdint>
#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "map/update_feed.h"
#include "run/simulation.h"

namespace navvy::link {

/// Returns a JSON value as text for messages, shortened to 80 bytes and "..." if it is longer.
std::string shown(const nlohmann::json& value);
/// Returns `text` for messages, shortened to 80 bytes and "..." if it is longer. Control characters
/// are replaced by "?".
std::string shown(const std::string& text);

/// Requests that a program allows its controller to make.
struct ControlServices {
  /// True if the controller may request pictures.
  bool images = true;
  /// True if the controller may save states to files and load them.
  bool files = true;
};

/// Answers requests of a controller (docs/reference/control_protocol.md).
///
/// A request is a JSON object with one key: "info", "heights", "changed", "arrays", "frames",
/// "particles", "image", "reset", "save", "load", "watch", "order" or "progress". Simulated time
/// does not advance while a request is answered.
///
/// The requests "heights" and "changed" use a map that this class makes at its construction and
/// updates at each such request.
class ControlRequests {
 public:
  /// Stores a reference to `simulation`, which must outlive this object. `rate` is the number of
  /// control steps per simulated second, which the request "info" reports.
  ControlRequests(run::Simulation& simulation, double rate, ControlServices services = {});

  /// Returns true if `line` contains the key of a request, such as "info". Otherwise it is a line
  /// that sets inputs.
  static bool is_request(const nlohmann::json& line);
  /// Returns the answer to a request: an object with the key of the request. @throws Error if the
  /// request cannot be answered; the simulation is then unchanged.
  nlohmann::json answer(const nlohmann::json& line);
  /// Returns true if the last answered request replaced the state of the simulation ("reset" or
  /// "load"), so that its outputs have changed.
  bool moved() const { return moved_; }
  /// Returns the bytes that follow the line of the last answer: the elements of the arrays of
  /// "frames" or "particles"; empty after all other requests.
  const std::string& bytes() const { return bytes_; }

 private:
  /// Returns the answer to the request `key` with the value `what`. (`answer` puts it into an
  /// object under this key.)
  nlohmann::json dispatch(const std::string& key, const nlohmann::json& what);
  /// Answers "heights": values of a map layer at the cells of a rectangle.
  nlohmann::json heights(const nlohmann::json& what);
  /// Answers "changed": rectangles that changed since the map with sequence number `what`.
  nlohmann::json changed(const nlohmann::json& what);
  /// Answers "arrays": the latest samples of the named arrays, or of all arrays.
  nlohmann::json arrays(const nlohmann::json& what) const;
  /// Answers "frames": as "arrays", with the elements as bytes behind the line.
  nlohmann::json frames(const nlohmann::json& what);
  /// Answers "particles": the named quantities of all active particles, or all quantities, with the
  /// elements as bytes behind the line.
  nlohmann::json particles(const nlohmann::json& what);
  /// Answers "image": the picture of a camera as PNG.
  nlohmann::json image(const nlohmann::json& what) const;
  /// Answers "info": scene, device, rates, site and channels.
  nlohmann::json info() const;
  /// Answers "watch": adds outputs for a link, and returns their names and units.
  nlohmann::json watch(const nlohmann::json& what);
  /// Answers "order": gives a machine a new program.
  nlohmann::json order(const nlohmann::json& what);
  /// Answers "progress": what programs have done and do, and the score of the job so far.
  nlohmann::json progress() const;
  /// Answers "save": writes the state of the simulation to a file.
  nlohmann::json save(const nlohmann::json& what) const;
  /// Replaces the state of the simulation by calling `load`, starts a new map, and returns the
  /// answer with the new time and step count.
  nlohmann::json replaced(const std::function<void()>& load);
  /// Updates the map to the current terrain and returns the latest update.
  map::UpdateFeed::Update now();

  /// Simulation that answers the requests.
  run::Simulation& simulation_;
  /// Number of control steps per simulated second.
  double rate_;
  /// Requests that the controller may make.
  ControlServices services_;
  /// Numbered maps for the requests "heights" and "changed", with all layers.
  map::UpdateFeed feed_;
  /// True if the last answered request replaced the state of the simulation.
  bool moved_ = false;
  /// Bytes that follow the line of the last answer.
  std::string bytes_;
};

}  // namespace navvy::link
