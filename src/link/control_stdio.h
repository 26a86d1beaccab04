// SPDX-License-Identifier: Apache-2.0
// Lock-step control over standard input and output: any language can drive.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "link/control_requests.h"

namespace navvy::link {

/// At each control step prints {"time":..., "outputs":{name: value}} as one line and reads one line
/// {"inputs": {name: value}} (only the inputs that change; the first one of a machine takes it from
/// its program). {"end": true} ends the run.
///
/// Any number of requests may come before that line (control_requests.h); each is answered by one
/// line. After one that puts the session into another state the outputs are printed again.
///
/// A line that cannot be used changes nothing and is answered by {"error":..., "line":...};
/// simulated time stands still until one comes that can be used. A controller that goes away,
/// closing either stream, ends the run too.
class ControlStdio {
 public:
  /// @param stop asked while it waits for its controller: true ends the wait
  ControlStdio(run::Simulation& simulation, double rate, std::function<bool()> stop,
               ControlServices services = {});
  /// Exchanges when a control step is due. Returns false when the controller wants to end, is gone,
  /// or `stop` said so.
  bool exchange();
  /// How the controller went away without {"end": true}; empty while it is there.
  const std::string& gone() const { return gone_; }

  static constexpr std::size_t kLongestLine = std::size_t{1} << 20;  ///< [bytes]
  static constexpr int kDeepestNesting = 8;                          ///< a line needs 2

 private:
  enum class Read { kLine, kTooLong, kStopped, kEnded };
  Read read_line(std::string& line);
  bool say(const std::string& line);
  bool say_outputs();
  /// False when nobody reads the answer.
  bool answer(const nlohmann::json& request);
  /// False when the line ends the run. All of it is checked before any of it acts.
  bool obey(const nlohmann::json& in);

  std::function<bool()> stop_;
  std::string unread_;       ///< what came after the last line
  std::size_t scanned_ = 0;  ///< of `unread_`: no line ends before it
  bool skipping_ = false;    ///< within a line that is too long
  bool ended_ = false;       ///< nothing more will come
  std::string gone_;
  run::Simulation& simulation_;
  double rate_;  ///< of exchanges [1/s]
  ControlRequests requests_;
  std::uint64_t lines_ = 0;
};

}  // namespace navvy::link
