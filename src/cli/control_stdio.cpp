// SPDX-License-Identifier: Apache-2.0
#include "cli/control_stdio.h"

#include <algorithm>
#include <cmath>
#include <iostream>
#include <nlohmann/json.hpp>
#include <string>

#include "core/error.h"

namespace navvy::cli {

using nlohmann::json;

ControlStdio::ControlStdio(sim::Session& session, double rate)
    : session_(session),
      world_(session.world()),
      interval_(static_cast<std::uint64_t>(std::max(1.0, std::round(1 / (rate * world_.dt()))))) {}

bool ControlStdio::exchange() {
  if (world_.steps() % interval_ != 0) return true;
  json out;
  out["time"] = world_.time();
  json& values = out["outputs"];
  for (std::size_t i = 0; i < world_.outputs().size(); ++i)
    values[world_.outputs()[i].name] = world_.get(static_cast<int>(i));
  std::cout << out.dump() << "\n" << std::flush;
  std::string line;
  if (!std::getline(std::cin, line)) return false;
  ++lines_;
  const auto fault = [&](const std::string& element, const std::string& value, const std::string& rule) {
    return InputError(Fault{Fault::Severity::kError, "standard input", static_cast<int>(lines_), element, value, rule,
                            R"(send one line such as {"inputs": {"ew180/boom_joint/velocity": 0.1}})"});
  };
  const json in = json::parse(line, nullptr, false);
  if (!in.is_object()) throw fault("line", line.substr(0, 80), "must be one JSON object");
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
      world_.set(name, value.get<double>());
      session_.take_over(name);
    } catch (const InputError& error) {
      const Fault& cause = error.faults().front();
      throw InputError(Fault{cause.severity, "standard input", static_cast<int>(lines_), cause.element, cause.value,
                             cause.rule, cause.remedy});
    }
  }
  return true;
}

}  // namespace navvy::cli
