// SPDX-License-Identifier: Apache-2.0
#include "link/control_stdio.h"

#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <climits>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/error.h"
#include "sim/timing.h"

namespace navvy::link {

using nlohmann::json;

namespace {

constexpr std::size_t kLongestName = 1000;
constexpr std::string_view kSeverity = "error: ";
// Interval at which `stop_` is asked while waiting [ms].
constexpr int kPatience = 100;

/// Returns the maximum number of nested brackets and braces outside of strings. This is checked
/// before the parser, which would build them all.
int nesting(const std::string& line) {
  int depth = 0, deepest = 0;
  bool text = false;
  for (std::size_t i = 0; i < line.size(); ++i) {
    const char c = line[i];
    if (text) {
      if (c == '\\') ++i;
      text = c != '"';
      continue;
    }
    if (c == '"') text = true;
    if (c == '[' || c == '{') deepest = std::max(deepest, ++depth);
    if (c == ']' || c == '}') --depth;
  }
  return deepest;
}

/// Returns the error of a line of inputs, with an example of a valid line.
InputError fault(const std::string& element, const std::string& value, const std::string& rule) {
  return InputError(
      Fault{Fault::Severity::kError, "", 0, element, value, rule,
            R"(send one line such as {"inputs": {"ew180/boom_joint/velocity": 0.1}})"});
}

/// Parses a line, which must be a JSON object.
json parsed(const std::string& line) {
  if (nesting(line) > ControlStdio::kDeepestNesting)
    throw fault("line", shown(line),
                "must nest at most " + std::to_string(ControlStdio::kDeepestNesting) + " deep");
  // The parser does not throw, so that both kinds of wrong lines get the same error. It would take
  // the last of two values of one name.
  std::vector<std::set<std::string>> open;
  std::string twice;
  const auto look = [&](int, json::parse_event_t event, const json& value) {
    if (event == json::parse_event_t::object_start) open.emplace_back();
    if (event == json::parse_event_t::object_end) open.pop_back();
    if (event == json::parse_event_t::key && !open.back().insert(value).second)
      twice = value.get<std::string>();
    return true;
  };
  json in = json::parse(line, look, false);
  if (!in.is_object()) throw fault("line", shown(line), "must be one JSON object");
  if (!twice.empty()) throw fault(shown(twice), "", "stands twice in one object");
  return in;
}

/// Returns a value as a line of text. Invalid UTF-8 is replaced.
std::string line_of(const json& out) {
  return out.dump(-1, ' ', false, json::error_handler_t::replace) + "\n";
}

}  // namespace

/// The base step divides the period of the rate. After loading a snapshot with another base step,
/// exchanges use the nearest step.
ControlStdio::ControlStdio(run::Simulation& simulation, double rate, std::function<bool()> stop,
                           ControlServices services)
    : stop_(std::move(stop)),
      simulation_(simulation),
      rate_(rate),
      requests_(simulation, rate, services) {}

/// Reads the next line, without its end. Looks at each byte once, in whatever pieces the line
/// arrives.
ControlStdio::Read ControlStdio::read_line(std::string& line) {
  // Not by std::cin: a signal just before a blocking read would be missed.
  for (;;) {
    const std::size_t end = unread_.find('\n', scanned_);
    if (end != std::string::npos) {
      line = unread_.substr(0, end);
      unread_.erase(0, end + 1);
      scanned_ = 0;
      if (std::exchange(skipping_, false) || line.size() > kLongestLine) return Read::kTooLong;
      return Read::kLine;
    }
    scanned_ = unread_.size();
    // The rest of a line that is too long is skipped.
    if (unread_.size() > kLongestLine) {
      skipping_ = true;
      unread_.clear();
      scanned_ = 0;
    }
    // The last line may lack its end.
    if (ended_) {
      line = std::exchange(unread_, "");
      scanned_ = 0;
      if (std::exchange(skipping_, false)) return Read::kTooLong;
      return line.empty() ? Read::kEnded : Read::kLine;
    }
    pollfd in{STDIN_FILENO, POLLIN, 0};
    const int ready = poll(&in, 1, kPatience);
    if (stop_()) return Read::kStopped;
    // No input yet, or a signal: `stop_` is asked again.
    if (ready <= 0) continue;
    char bytes[65536];
    const ssize_t got = read(STDIN_FILENO, bytes, sizeof bytes);
    if (got < 0 && (errno == EINTR || errno == EAGAIN)) continue;
    if (got <= 0)
      ended_ = true;
    else
      unread_.append(bytes, static_cast<std::size_t>(got));
  }
}

/// Writes a line. Returns false if the reader is gone, or if `stop_` ends the wait for it.
bool ControlStdio::say(const std::string& line) {
  for (std::size_t at = 0; at < line.size();) {
    pollfd out{STDOUT_FILENO, POLLOUT, 0};
    const int ready = poll(&out, 1, kPatience);
    if (stop_()) return false;
    if (ready <= 0) continue;
    // A ready pipe takes this many bytes without blocking.
    const ssize_t put =
        write(STDOUT_FILENO, line.data() + at, std::min<std::size_t>(line.size() - at, PIPE_BUF));
    if (put < 0 && (errno == EINTR || errno == EAGAIN)) continue;
    if (put < 0) {
      gone_ = "the controller closed standard output";
      return false;
    }
    at += static_cast<std::size_t>(put);
  }
  return true;
}

/// Sends time and all outputs.
bool ControlStdio::say_outputs() {
  json out;
  out["time"] = simulation_.time();
  json& values = out["outputs"];
  for (std::size_t i = 0; i < simulation_.outputs().size(); ++i)
    values[simulation_.outputs()[i].name] = simulation_.get(static_cast<int>(i));
  return say(line_of(out));
}

bool ControlStdio::answer(const json& request) {
  const json said = requests_.answer(request);
  if (!say(line_of(said)) || !say(requests_.bytes())) return false;
  // The next inputs refer to the present state, so its outputs are sent again.
  return !requests_.moved() || say_outputs();
}

/// Sends the outputs first, so that the controller can answer them.
bool ControlStdio::exchange() {
  if (!sim::sample_due(simulation_.world().steps(), simulation_.world().dt(), rate_)) return true;
  if (!say_outputs()) return false;
  // Simulated time stands still until a valid answer arrives.
  for (;;) {
    std::string line;
    const Read read = read_line(line);
    if (read == Read::kStopped) return false;
    if (read == Read::kEnded) {
      gone_ = R"(the controller closed standard input without {"end": true})";
      return false;
    }
    ++lines_;
    try {
      if (read == Read::kTooLong)
        throw fault("line", "", "must have at most " + std::to_string(kLongestLine) + " bytes");
      const json in = parsed(line);
      if (!ControlRequests::is_request(in)) return obey(in);
      if (!answer(in)) return false;
    } catch (const Error& error) {
      // The controller may correct its mistake, so the run goes on.
      std::string text = error.what();
      // The key of the answer contains the severity.
      if (text.rfind(kSeverity, 0) == 0) text.erase(0, kSeverity.size());
      if (!say(line_of({{"error", text}, {"line", lines_}}))) return false;
    }
  }
}

bool ControlStdio::obey(const json& in) {
  // A misspelt key would otherwise be an input that never arrives.
  for (const auto& [key, value] : in.items())
    if (key != "inputs" && key != "end")
      throw fault(key, shown(value), "must be 'inputs' or 'end', or a request");
  if (in.contains("end") && !in["end"].is_boolean())
    throw fault("end", shown(in["end"]), "must be true or false");
  std::vector<std::pair<int, double>> inputs;
  if (in.contains("inputs")) {
    if (!in["inputs"].is_object())
      throw fault("inputs", shown(in["inputs"]), "must be an object of names and numbers");
    for (const auto& [name, value] : in["inputs"].items()) {
      // No channel has such a long name, and a search for the nearest one would be slow.
      if (name.size() > kLongestName) throw fault(shown(name), shown(value), "is no input");
      if (!value.is_number() || !std::isfinite(value.get<double>()))
        throw fault(shown(name), shown(value), "must be a number");
      // Inputs are looked up by name each time: controllers send few, and the look-up is fast.
      inputs.emplace_back(simulation_.input(name), value.get<double>());
    }
  }
  // Everything in the line is valid, so it takes effect as a whole.
  for (const auto& [input, value] : inputs) simulation_.set(input, value);
  return !in.value("end", false);
}

}  // namespace navvy::link
