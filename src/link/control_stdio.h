// SPDX-License-Identifier: Apache-2.0
// Lock-step control of a simulation over standard input and output, for controllers in any
// language.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "link/control_requests.h"

namespace navvy::link {

/// Runs a simulation in lock step with a controller that is connected to standard input and output.
///
/// The simulation prints one line {"time": ..., "outputs": {name: value}} at each control step and
/// reads one line {"inputs": {name: value}}. The controller sends only inputs that change. Once an
/// input of a machine is set, the machine no longer follows its program. The line {"end": true}
/// ends the run.
///
/// Before its inputs, the controller may send any number of requests (control_requests.h). Each is
/// answered by one line. After a request that replaces the state, the outputs are printed again.
///
/// An invalid line changes nothing. It is answered by {"error": ..., "line": ...}, and the
/// simulation waits for a valid line. If the controller closes either stream, the run ends.
class ControlStdio {
 public:
  /// Stores a reference to `simulation`, which must outlive this object.
  /// @param rate number of control steps per simulated second
  /// @param stop function that is called repeatedly while waiting for the controller; if it returns
  /// true, the wait ends
  /// @param services requests that the controller may make
  ControlStdio(run::Simulation& simulation, double rate, std::function<bool()> stop,
               ControlServices services = {});
  /// Sends outputs and receives inputs if a control step is due. Must be called before each
  /// simulation step. Returns false if the controller ended the run or disconnected, or if `stop`
  /// ended the wait.
  bool exchange();
  /// Returns a message that explains how the controller disconnected without sending {"end": true};
  /// empty if it did not.
  const std::string& gone() const { return gone_; }

  /// Maximum length of a line [bytes].
  static constexpr std::size_t kLongestLine = std::size_t{1} << 20;
  /// Maximum nesting depth of brackets and braces in a line. Valid lines need at most 3.
  static constexpr int kDeepestNesting = 8;

 private:
  /// Result of reading a line: a line was read, a line was skipped because it is too long, `stop`
  /// ended the wait, or the input has ended.
  enum class Read { kLine, kTooLong, kStopped, kEnded };
  /// Reads the next line, without its line end, into `line`. Blocks until there is one, the input
  /// ends, or `stop` ends the wait.
  Read read_line(std::string& line);
  /// Writes `line` to standard output. Returns false if the controller closed the stream or `stop`
  /// ended the wait.
  bool say(const std::string& line);
  /// Writes a line with the time and all outputs to standard output. Returns false if the
  /// controller closed the stream or `stop` ended the wait.
  bool say_outputs();
  /// Answers a request, and writes the outputs again if the request replaced the state. Returns
  /// false if the controller closed the stream or `stop` ended the wait. @throws Error if the
  /// request cannot be answered.
  bool answer(const nlohmann::json& request);
  /// Validates a line of inputs and then sets them. Returns false if the line ends the run. @throws
  /// InputError for an invalid line, which then sets nothing.
  bool obey(const nlohmann::json& in);

  /// Function that ends waiting for the controller by returning true.
  std::function<bool()> stop_;
  /// Bytes that were received but are not yet part of a line that was read.
  std::string unread_;
  /// Number of bytes at the start of `unread_` that are known to contain no line end.
  std::size_t scanned_ = 0;
  /// True while the rest of a line that is too long is skipped.
  bool skipping_ = false;
  /// True after standard input has ended.
  bool ended_ = false;
  /// Message that explains how the controller disconnected; empty if it did not.
  std::string gone_;
  /// Simulation that the controller drives.
  run::Simulation& simulation_;
  /// Number of control steps per simulated second.
  double rate_;
  /// Answers the requests of the controller.
  ControlRequests requests_;
  /// Number of lines read so far, for error messages.
  std::uint64_t lines_ = 0;
};

}  // namespace navvy::link
