// SPDX-License-Identifier: Apache-2.0
#include "link/view_commands.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <nlohmann/json.hpp>

#include "core/error.h"
#include "link/control_requests.h"

namespace navvy::link {
namespace {

using nlohmann::json;

constexpr double kSlowest = 0.001, kFastest = 1000;  // simulated seconds per second
constexpr std::size_t kLongestName = 1000;

[[noreturn]] void refuse(const std::string& key, const json& value, const std::string& rule) {
  throw InputError(Fault{Fault::Severity::kError, "", 0, key, shown(value), rule,
                         R"(send one such as {"pause": true}, {"step": 10}, {"pace": 1} or )"
                         R"({"inputs": {"ew180/boom_joint/velocity": 0.1}})"});
}

double number_of(const std::string& key, const json& value) {
  if (!value.is_number() || !std::isfinite(value.get<double>()))
    refuse(key, value, "must be a number");
  return value.get<double>();
}

std::vector<std::pair<int, double>> inputs_of(const json& values, const sim::Inputs& known) {
  if (!values.is_object()) refuse("inputs", values, "must be an object of names and numbers");
  std::vector<std::pair<int, double>> out;
  for (const auto& [name, value] : values.items()) {
    // No channel has such a long name, and a search for the nearest one would be slow.
    if (name.size() > kLongestName) refuse(shown(name), value, "is no input");
    out.emplace_back(known.index(name), number_of(shown(name), value));
    known.require(out.back().first, out.back().second);
  }
  return out;
}

}  // namespace

ViewCommands::ViewCommands(const sim::Inputs& inputs, std::string refusal)
    : inputs_(inputs), refusal_(std::move(refusal)) {}

void ViewCommands::add(const std::string& text) {
  const json in = json::parse(text, nullptr, false);
  if (!in.is_object()) refuse("command", text, "must be one JSON object");
  Pending more;
  for (const auto& [key, value] : in.items()) {
    if (key == "pause") {
      if (!value.is_boolean()) refuse(key, value, "must be true or false");
      more.pause = value.get<bool>();
    } else if (key == "step") {
      const double steps = number_of(key, value);
      if (steps < 1 || steps > kMostSteps || steps != std::floor(steps))
        refuse(key, value, "must be a whole number from 1 to " + std::to_string(kMostSteps));
      more.steps = static_cast<long>(steps);
    } else if (key == "pace") {
      const double pace = number_of(key, value);
      if (pace != 0 && (pace < kSlowest || pace > kFastest))
        refuse(key, value, "must be 0, or from 0.001 to 1000 simulated seconds per second");
      more.pace = pace;
    } else if (key == "inputs") {
      if (!refusal_.empty()) refuse(key, "", refusal_);
      more.inputs = inputs_of(value, inputs_);
    } else {
      refuse(shown(key), value, "must be pause, step, pace or inputs");
    }
  }
  const std::lock_guard<std::mutex> lock(mutex_);
  // A pause ends steps that were asked for before, and a step pauses after itself.
  if (more.pause) pending_.steps = 0;
  if (more.pause) pending_.pause = more.pause;
  pending_.steps = std::min(pending_.steps + more.steps, kMostSteps);
  if (more.pace) pending_.pace = more.pace;
  for (const auto& one : more.inputs) {
    std::erase_if(pending_.inputs, [&](const auto& old) { return old.first == one.first; });
    pending_.inputs.push_back(one);
  }
  any_ = true;
  added_.notify_all();
}

ViewCommands::Pending ViewCommands::take() {
  const std::lock_guard<std::mutex> lock(mutex_);
  any_ = false;
  return std::exchange(pending_, Pending());
}

void ViewCommands::wait(double patience) {
  std::unique_lock<std::mutex> lock(mutex_);
  added_.wait_for(lock, std::chrono::duration<double>(patience), [&] { return any_; });
}

}  // namespace navvy::link
