// SPDX-License-Identifier: Apache-2.0
#include "cli/lab_output.h"

#include <cctype>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "device/device.h"
#include "scene/soil_values.h"
#include "soil/scheme.h"

namespace navvy::cli {
namespace {

/// Returns the JSON key of a quantity with its unit, as in scene files: "farthest motion", "mm" ->
/// "farthest_motion_mm".
std::string key(const std::string& name, const std::string& unit) {
  std::string out;
  for (const char c : unit.empty() ? name : name + "_" + unit)
    out += std::isalnum(static_cast<unsigned char>(c)) != 0 ? c : c == '%' ? 'p' : '_';
  return out;
}

/// Returns a number, or null for a quantity that could not be measured: JSON has no NaN.
nlohmann::json number(double value) {
  return std::isfinite(value) ? nlohmann::json(value) : nlohmann::json(nullptr);
}

/// Returns all numbers of a soil under their names in scene files.
nlohmann::json soil_json(scene::Soil soil) {
  nlohmann::json out = {{"name", soil.name}, {"source", soil.source}};
  for (const scene::SoilValue& v : scene::soil_values(soil)) out[v.name] = v.written();
  return out;
}

/// Returns a number as text; empty for NaN.
std::string text_of(double value) { return std::isnan(value) ? "" : lab::short_text(value); }

/// Prints supplied, stored and dissipated energy [J], then the remainder.
void print_energy(const soil::EnergyAccount& energy) {
  std::string text;
  soil::report_energy(energy, [&](const char* name, double joule) {
    text += (text.empty() ? " " : ", ") + std::string(name) + " " + lab::short_text(joule);
  });
  std::printf("energy [J]:%s\n", text.c_str());
}

}  // namespace

nlohmann::json to_json(const lab::Rig& rig, const lab::Setup& setup, const lab::Report& report) {
  nlohmann::json out;
  out["rig"] = rig.name;
  out["version"] = NAVVY_VERSION;
  // Results are bit-identical on one device only, so the device is part of them.
  out["device"] = setup.device->info().text();
  // Inputs come first, so that a file contains all that its results depend on.
  nlohmann::json& inputs = out["inputs"];
  inputs["soil"] = soil_json(setup.soil);
  inputs["cell_m"] = setup.cell;
  // Only what the experiment changed: the defaults follow from the version.
  for (const soil::SchemeConstant& row : soil::scheme_constants())
    if (setup.scheme.*row.value != row.standard())
      inputs["scheme"][row.name] = setup.scheme.*row.value;
  for (const lab::Parameter& p : rig.parameters)
    inputs["geometry"][key(p.name, p.unit)] = setup[p.name];
  for (const lab::Quantity& q : report.results) {
    const std::string name = key(q.name, q.unit);
    out["result"][name] = number(q.measured);
    out["expected"][name] = number(q.expected);
    // Absent if there is no tolerance.
    if (q.has_tolerance()) out["tolerance"][name] = {number(q.low), number(q.high)};
    if (!q.source.empty()) out["source"][name] = q.source;
    if (q.outside_tolerance()) out["outside_tolerance"].push_back(name);
    // The setups for which the tolerance holds, if this one is none of them.
    if (!q.in_range) out["not_judged"][name] = q.range;
  }
  // Curves over time or travel, where the rig measures one.
  for (const lab::Series& s : report.series) {
    nlohmann::json& values = out["series"][key(s.name, s.unit)] = nlohmann::json::array();
    for (const double v : s.values) values.push_back(number(v));
  }
  if (report.energy)
    soil::report_energy(*report.energy, [&](const char* name, double joule) {
      out["energy_j"][name] = number(joule);
    });
  out["particles_peak"] = report.particles_peak;
  out["steps"] = report.steps;
  out["simulated_time_s"] = report.simulated_time;
  out["wall_time_s"] = report.wall_time;
  out["ledger_error_quanta"] = report.ledger_error;
  out["state_hash"] = report.state_hash;
  return out;
}

void print_table(const lab::Report& report) {
  std::printf("%-40s %14s %12s %-24s %s\n", "quantity", "measured", "expected", "tolerance",
              "source");
  for (const lab::Quantity& q : report.results) {
    const std::string tolerance =
        q.has_tolerance() ? text_of(q.low) + " .. " + text_of(q.high) : "";
    std::printf("%-40s %14s %12s %-24s %s\n",
                (q.name + (q.unit.empty() ? "" : " [" + q.unit + "]")).c_str(),
                (std::isnan(q.measured) ? "nan" : text_of(q.measured)).c_str(),
                text_of(q.expected).c_str(),
                (tolerance + (q.outside_tolerance() ? "  outside"
                              : q.in_range          ? ""
                                                    : "  not judged"))
                    .c_str(),
                q.source.c_str());
  }
  for (const lab::Quantity& q : report.results)
    if (!q.in_range)
      std::printf("not judged: %s; its tolerance applies to %s\n", q.name.c_str(), q.range.c_str());
  if (report.energy) print_energy(*report.energy);
  std::printf("%d particles, %llu steps, %.2f s simulated in %.1f s; ledger %lld, hash %s\n",
              report.particles_peak, static_cast<unsigned long long>(report.steps),
              report.simulated_time, report.wall_time, static_cast<long long>(report.ledger_error),
              report.state_hash.c_str());
}

}  // namespace navvy::cli
