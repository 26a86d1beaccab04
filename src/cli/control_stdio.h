// SPDX-License-Identifier: Apache-2.0
// Lock-step control over standard input and output: any language can drive.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "session/session.h"

namespace navvy::cli {

/// At each control step prints {"time":..., "outputs":{name: value}} as one line and reads one line {"inputs": {name:
/// value}} (only the inputs that change; the first one of a machine takes it from its program). {"end": true} or end of
/// file ends the run.
class ControlStdio {
 public:
  /// @param stop asked while it waits for a line: true ends the wait as the end of the stream does
  ControlStdio(session::Session& session, double rate, std::function<bool()> stop);
  /// Exchanges when a control step is due. Returns false when the controller wants to end.
  /// @throws InputError naming line and key when the line is not as described.
  bool exchange();

 private:
  bool read_line(std::string& line);

  std::function<bool()> stop_;
  std::string unread_;  ///< what came after the last line
  session::Session& session_;
  const sim::World& world_;
  double rate_;  ///< of exchanges [1/s]
  std::uint64_t lines_ = 0;
};

}  // namespace navvy::cli
