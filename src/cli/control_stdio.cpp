// SPDX-License-Identifier: Apache-2.0
#include "cli/control_stdio.h"

#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <iostream>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>

#include "core/error.h"
#include "sim/timing.h"

namespace navvy::cli {

using nlohmann::json;

/// The base step was made to divide the period; after a snapshot with another base step exchanges take the nearest
/// step.
ControlStdio::ControlStdio(session::Session& session, double rate, std::function<bool()> stop)
    : stop_(std::move(stop)), session_(session), world_(session.world()), rate_(rate) {}

/// The next line without its end; false when the stream ended or `stop` said so.
bool ControlStdio::read_line(std::string& line) {
  // Not through std::cin: a signal that comes just before a blocking read would be lost in it.
  constexpr int kPatience = 100;  // [ms]
  for (std::size_t end = unread_.find('\n'); end == std::string::npos; end = unread_.find('\n')) {
    pollfd in{STDIN_FILENO, POLLIN, 0};
    const int ready = poll(&in, 1, kPatience);
    if (stop_()) return false;
    // Nothing yet, or a signal: ask `stop` again.
    if (ready <= 0) continue;
    char bytes[4096];
    const ssize_t got = read(STDIN_FILENO, bytes, sizeof bytes);
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) {  // the last line may lack its end
      line = std::exchange(unread_, "");
      return !line.empty();
    }
    unread_.append(bytes, static_cast<std::size_t>(got));
  }
  const std::size_t end = unread_.find('\n');
  line = unread_.substr(0, end);
  unread_.erase(0, end + 1);
  return true;
}

/// Outputs first, then inputs: the controller answers what it has just been told.
bool ControlStdio::exchange() {
  if (!sim::sample_due(world_.steps(), world_.dt(), rate_)) return true;
  json out;
  out["time"] = world_.time();
  json& values = out["outputs"];
  for (std::size_t i = 0; i < world_.outputs().size(); ++i)
    values[world_.outputs()[i].name] = world_.get(static_cast<int>(i));
  std::cout << out.dump() << "\n" << std::flush;
  // Lock step: simulated time stands still until the answer is there.
  std::string line;
  if (!read_line(line)) return false;
  ++lines_;
  // A controller's slip stops the run with the line's number: going on would hide it.
  const auto fault = [&](const std::string& element, const std::string& value, const std::string& rule) {
    return InputError(Fault{Fault::Severity::kError, "standard input", static_cast<int>(lines_), element, value, rule,
                            R"(send one line such as {"inputs": {"ew180/boom_joint/velocity": 0.1}})"});
  };
  // Without exceptions: a line that is no JSON is as much a fault as one of the wrong kind.
  const json in = json::parse(line, nullptr, false);
  if (!in.is_object()) throw fault("line", line.substr(0, 80), "must be one JSON object");
  // A misspelt key would otherwise be an input that never arrives.
  for (const auto& [key, value] : in.items())
    if (key != "inputs" && key != "end") throw fault(key, value.dump().substr(0, 80), "must be 'inputs' or 'end'");
  if (in.contains("end")) {
    if (!in["end"].is_boolean()) throw fault("end", in["end"].dump().substr(0, 80), "must be true or false");
    if (in["end"].get<bool>()) return false;
  }
  if (!in.contains("inputs")) return true;
  if (!in["inputs"].is_object()) throw fault("inputs", in["inputs"].dump(), "must be an object of names and numbers");
  for (const auto& [name, value] : in["inputs"].items()) {
    if (!value.is_number()) throw fault(name, value.dump(), "must be a number");
    try {
      // By name each time: controllers send few inputs, and the map is fast.
      session_.set(name, value.get<double>());
    } catch (const InputError& error) {
      // The world knows the channel; here the line is added.
      const Fault& cause = error.faults().front();
      throw InputError(Fault{cause.severity, "standard input", static_cast<int>(lines_), cause.element, cause.value,
                             cause.rule, cause.remedy});
    }
  }
  return true;
}

}  // namespace navvy::cli
