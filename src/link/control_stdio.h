// SPDX-License-Identifier: Apache-2.0
// Lock-step control over standard input and output, for programs in any language.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "link/control_requests.h"

namespace navvy::link {

/// Drives a simulation in lock step with a controller on standard input and output.
///
/// At each control step it prints one line {"time": ..., "outputs": {name: value}} and reads one
/// line {"inputs": {name: value}}, which contains only inputs that change. The first input of a
/// machine takes it from its program. {"end": true} ends the run.
///
/// Before its inputs a controller may send any number of requests (control_requests.h), each
/// answered by one line. After a request that replaces the state the outputs are printed again.
///
/// A line that is not valid changes nothing and is answered by {"error": ..., "line": ...};
/// simulated time stands still until a valid line arrives. A controller that closes either stream
/// ends the run.
class ControlStdio {
 public:
  /// Keeps a reference to `simulation`. `rate` is the number of control steps per simulated second.
  /// `stop` is asked while waiting for the controller; true ends the wait.
  ControlStdio(run::Simulation& simulation, double rate, std::function<bool()> stop,
               ControlServices services = {});
  /// Exchanges outputs and inputs if a control step is due. Call it before each step. Returns false
  /// if the controller ended the run or is gone, or if `stop` ended the wait.
  bool exchange();
  /// Returns how the controller went away without {"end": true}; empty while it is there.
  const std::string& gone() const { return gone_; }

  /// Maximum length of a line [bytes].
  static constexpr std::size_t kLongestLine = std::size_t{1} << 20;
  /// Maximum nesting of brackets and braces in a line. Valid lines need at most 3.
  static constexpr int kDeepestNesting = 8;

 private:
  /// Result of reading from the input.
  enum class Read { kLine, kTooLong, kStopped, kEnded };
  /// Reads the next line; blocks until there is one, the input ends, or `stop` ends the wait.
  Read read_line(std::string& line);
  /// Writes a line, or a line with time and outputs. Both return false if the reader is gone.
  bool say(const std::string& line);
  bool say_outputs();
  /// Answers a request. Returns false if the controller is gone.
  bool answer(const nlohmann::json& request);
  /// Checks a whole line and then sets its inputs. Returns false if the line ends the run.
  bool obey(const nlohmann::json& in);

  std::function<bool()> stop_;
  std::string unread_;       ///< input after the last line
  std::size_t scanned_ = 0;  ///< `unread_` has no line end before this index
  bool skipping_ = false;    ///< within a line that is too long
  bool ended_ = false;       ///< end of the input
  std::string gone_;         ///< how the controller went away
  run::Simulation& simulation_;
  double rate_;  ///< control steps per simulated second
  ControlRequests requests_;
  std::uint64_t lines_ = 0;  ///< lines read, for error messages
};

}  // namespace navvy::link
