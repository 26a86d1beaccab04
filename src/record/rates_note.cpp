// SPDX-License-Identifier: Apache-2.0
#include "record/rates_note.h"

#include <cmath>
#include <cstdio>
#include <vector>

namespace navvy::record {
namespace {

/// Relative tolerance for the rounding of a whole number of steps.
constexpr double kWhole = 1e-9;

/// Returns a formatted number.
std::string number(const char* format, double value) {
  char text[40];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

/// Returns names as "a, b and c".
std::string list(const std::vector<std::string>& names) {
  std::string out;
  for (std::size_t i = 0; i < names.size(); ++i)
    out += (i == 0 ? "" : i + 1 == names.size() ? " and " : ", ") + names[i];
  return out;
}

}  // namespace

std::string rates_note(const sim::World& world, double control_rate, double particle_rate) {
  const double dt = world.dt();
  // Rates that the steps meet exactly are not mentioned.
  std::vector<std::string> nearest, every;
  const auto look = [&](const std::string& name, double rate) {
    if (!(rate > 0)) return;
    // Number of base steps in a period: below 1 every step is used, a fraction means the nearest
    // step.
    const double steps = 1 / (rate * dt);
    const std::string text = name + " (" + number("%g", rate) + " Hz)";
    if (steps < 1 - kWhole)
      every.push_back(text);
    else if (std::abs(steps - std::round(steps)) > kWhole * steps)
      nearest.push_back(text);
  };
  look("control", control_rate);
  look("telemetry", world.description().recording.telemetry_rate);
  look("particles", particle_rate);
  if (world.description().recording.render)
    for (const scene::Camera& camera : world.description().cameras)
      look("camera '" + camera.name + "'", camera.rate);

  std::vector<std::string> parts;
  // A step shorter than the soil needs costs time and changes results a little, so its cause is
  // reported.
  if (dt < world.longest_step() * (1 - kWhole))
    parts.push_back(
        "a whole number of base steps makes up a control step; without it they would be " +
        number("%.4g", 1e3 * world.longest_step()) + " ms");
  const scene::Scene& scene = world.description();
  if (!scene.soils.empty() && world.longest_step() >= scene.solver.max_step * (1 - kWhole))
    parts.push_back("max_step_s of the solver allows no longer ones, though the soil does");
  if (!nearest.empty())
    parts.push_back(list(nearest) + (nearest.size() == 1 ? " takes" : " take") +
                    " the nearest step, at most " + number("%.2g", 0.5e3 * dt) +
                    " ms off at any time");
  if (!every.empty())
    parts.push_back(list(every) + (every.size() == 1 ? " gets" : " get") + " every step, " +
                    number("%.4g", 1 / dt) + " a second");
  if (parts.empty()) return "";
  std::string out = "base step " + number("%.4g", 1e3 * dt) + " ms: ";
  for (std::size_t i = 0; i < parts.size(); ++i) out += (i == 0 ? "" : "; ") + parts[i];
  return out;
}

}  // namespace navvy::record
