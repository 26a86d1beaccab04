// SPDX-License-Identifier: Apache-2.0
// `navvy lab`: one experiment on soil, its result as a table and as JSON.
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "cli/commands.h"
#include "cli/exit_code.h"
#include "cli/validators.h"
#include "core/edit_distance.h"
#include "core/error.h"
#include "core/file.h"
#include "core/math.h"
#include "core/stopwatch.h"
#include "device/device.h"
#include "lab/lab.h"
#include "lab/soils.h"
#include "scene/soil_values.h"
#include "scene_io/loader.h"

namespace navvy::cli {
namespace {

/// One soil value that may be given by itself.
struct SoilOption {
  const char* name;
  const char* help;
  std::optional<double> value;
};

struct LabOptions {
  std::string rig, device, json, soil;
  std::optional<double> cell;
  std::map<std::string, double> geometry;
  std::vector<SoilOption> soil_values = {
      {"--phi-deg", "friction angle phi (plane strain) [deg]", {}},
      {"--repose-deg", "angle of repose t instead of phi: sin phi = tan t [deg]", {}},
      {"--cohesion-pa", "cohesion c, residual cohesion too unless the soil's is lower [Pa]", {}},
      {"--density", "bank density [kg/m3]", {}},
      {"--young-pa", "Young's modulus, softened for speed [Pa]", {}},
      {"--poisson", "Poisson's ratio [-]", {}},
      {"--swell", "loose volume / bank volume [-]", {}},
      {"--dilatancy-deg", "dilatancy angle psi in bank state [deg]; needs a swell", {}},
      {"--fast-phi-deg", "mu(I): friction angle of fast flow [deg]", {}},
      {"--grain-m", "mu(I): grain diameter [m]", {}},
      {"--inertial-number", "mu(I): inertial number at half the growth [-]", {}},
      {"--delta-deg", "friction angle of soil on tool [deg]", {}},
      {"--adhesion-pa", "adhesion of soil on tool [Pa]", {}},
  };
  std::vector<std::string> settings;  // NAME=VALUE of scene::soil_values
  bool quiet = false;
};

std::string wrapped(const std::string& text, std::size_t width = 100) {
  std::string out;
  std::size_t column = 0, at = 0;
  while (at < text.size()) {
    const std::size_t end = std::min(text.find(' ', at), text.size());
    if (column > 0 && column + 1 + end - at > width) {
      out += '\n';
      column = 0;
    } else if (column > 0) {
      out += ' ';
      ++column;
    }
    out.append(text, at, end - at);
    column += end - at;
    at = end + 1;
  }
  return out;
}

int list_rigs() {
  std::puts(
      "The virtual soil laboratory. `navvy lab RIG` runs an experiment, `navvy lab RIG --help` draws it in words.\n");
  for (const lab::Rig& rig : lab::rigs()) std::printf("  %-12s %s\n", rig.name.c_str(), rig.summary.c_str());
  return kOk;
}

/// The shipped soil of this name. @throws InputError naming the nearest.
scene::Soil shipped_soil(const std::string& name) {
  const std::string directory = scene_io::find_data("terrain/soils");
  std::string best;
  std::size_t least = static_cast<std::size_t>(-1);
  if (!directory.empty())
    for (const scene::Soil& soil : scene_io::load_soils(directory)) {
      if (soil.name == name) return soil;
      const std::size_t distance = edit_distance(soil.name, name);
      if (distance < least) least = distance, best = soil.name;
    }
  throw InputError(Fault{Fault::Severity::kError, "", 0, "--soil", name, "a soil that `navvy soils` lists",
                         best.empty() ? "set NAVVY_DATA_DIR" : "did you mean '" + best + "'?"});
}

/// Sets a number of the soil by its name in scene files, in that file's unit.
void set_value(scene::Soil& soil, const std::string& setting) {
  const auto [name, text] = scene_io::parse_setting(setting);
  std::string best;
  std::size_t least = static_cast<std::size_t>(-1);
  for (const scene::SoilValue& value : scene::soil_values()) {
    if (name == value.name) {
      double number = 0;
      const char* end = text.data() + text.size();
      const auto [stop, failed] = std::from_chars(text.data(), end, number);
      if (failed != std::errc() || stop != end)
        throw InputError(Fault{Fault::Severity::kError, "", 0, "--set " + name, text, "must be a number", ""});
      soil.*value.value = number * value.factor;
      return;
    }
    const std::size_t distance = edit_distance(value.name, name);
    if (distance < least) least = distance, best = value.name;
  }
  throw InputError(Fault{Fault::Severity::kError, "", 0, "--set", name,
                         "a number of a soil, by its name in scene files", "did you mean '" + best + "'?"});
}

scene::Soil chosen_soil(const LabOptions& options, scene::Soil soil) {
  if (!options.soil.empty()) soil = shipped_soil(options.soil);
  const auto set = [&](const char* name, double& target, double scale = 1) {
    for (const SoilOption& option : options.soil_values)
      if (std::string(name) == option.name && option.value) target = *option.value * scale;
  };
  double repose = lab::kNone;
  set("--repose-deg", repose, kPi / 180);
  if (!std::isnan(repose)) soil.friction_angle = lab::friction_from_repose(repose);
  set("--phi-deg", soil.friction_angle, kPi / 180);
  const double before = soil.cohesion;
  set("--cohesion-pa", soil.cohesion);
  if (soil.cohesion != before && (soil.residual_cohesion == before || soil.residual_cohesion > soil.cohesion))
    soil.residual_cohesion = soil.cohesion;
  set("--density", soil.bank_density);
  set("--young-pa", soil.young_modulus);
  set("--poisson", soil.poisson);
  set("--swell", soil.swell);
  set("--dilatancy-deg", soil.dilatancy_angle, kPi / 180);
  set("--fast-phi-deg", soil.fast_friction_angle, kPi / 180);
  set("--grain-m", soil.grain_diameter);
  set("--inertial-number", soil.inertial_number);
  set("--delta-deg", soil.tool_friction_angle, kPi / 180);
  set("--adhesion-pa", soil.adhesion);
  for (const std::string& setting : options.settings) set_value(soil, setting);
  return soil;
}

/// "farthest motion", "mm" -> "farthest_motion_mm".
std::string key(const std::string& name, const std::string& unit) {
  std::string out;
  for (const char c : unit.empty() ? name : name + "_" + unit)
    out += std::isalnum(static_cast<unsigned char>(c)) != 0 ? c : c == '%' ? 'p' : '_';
  return out;
}

nlohmann::json number(double value) { return std::isfinite(value) ? nlohmann::json(value) : nlohmann::json(nullptr); }

/// Every number under its name in scene files.
nlohmann::json soil_json(const scene::Soil& soil) {
  nlohmann::json out = {{"name", soil.name}, {"source", soil.source}};
  for (const scene::SoilValue& v : scene::soil_values()) out[v.name] = v.written(soil);
  return out;
}

nlohmann::json to_json(const lab::Rig& rig, const lab::Setup& setup, const lab::Report& report) {
  nlohmann::json out;
  out["rig"] = rig.name;
  out["version"] = NAVVY_VERSION;
  out["device"] = setup.device->info().text();
  nlohmann::json& inputs = out["inputs"];
  inputs["soil"] = soil_json(setup.soil);
  inputs["cell_m"] = setup.cell;
  for (const lab::Parameter& p : rig.parameters) inputs["geometry"][key(p.name, p.unit)] = setup[p.name];
  for (const lab::Quantity& q : report.results) {
    const std::string name = key(q.name, q.unit);
    out["result"][name] = number(q.measured);
    out["expected"][name] = number(q.expected);
    if (q.has_gate()) out["gate"][name] = {number(q.low), number(q.high)};
    if (!q.source.empty()) out["source"][name] = q.source;
    if (q.missed()) out["missed"].push_back(name);
  }
  for (const lab::Series& s : report.series) {
    nlohmann::json& values = out["series"][key(s.name, s.unit)] = nlohmann::json::array();
    for (const double v : s.values) values.push_back(number(v));
  }
  out["particles_peak"] = report.particles_peak;
  out["steps"] = report.steps;
  out["simulated_time_s"] = report.simulated_time;
  out["wall_time_s"] = report.wall_time;
  out["ledger_error_quanta"] = report.ledger_error;
  out["state_hash"] = report.state_hash;
  return out;
}

std::string text_of(double value) {
  if (std::isnan(value)) return "";
  char buffer[32];
  std::snprintf(buffer, sizeof buffer, "%.5g", value);
  return buffer;
}

void print_table(const lab::Report& report) {
  std::printf("%-40s %14s %12s %-22s %s\n", "quantity", "measured", "expected", "gate", "source");
  for (const lab::Quantity& q : report.results) {
    const std::string gate = q.has_gate() ? text_of(q.low) + " .. " + text_of(q.high) : "";
    std::printf("%-40s %14s %12s %-22s %s\n", (q.name + (q.unit.empty() ? "" : " [" + q.unit + "]")).c_str(),
                (std::isnan(q.measured) ? "nan" : text_of(q.measured)).c_str(), text_of(q.expected).c_str(),
                (gate + (q.missed() ? "  MISS" : "")).c_str(), q.source.c_str());
  }
  std::printf("%d particles, %llu steps, %.2f s simulated in %.1f s; ledger %lld, hash %s\n", report.particles_peak,
              static_cast<unsigned long long>(report.steps), report.simulated_time, report.wall_time,
              static_cast<long long>(report.ledger_error), report.state_hash.c_str());
}

/// A line on a terminal with the share done; nothing when stderr is a file or pipe.
std::function<void(double)> progress_line(bool quiet) {
  if (quiet || isatty(STDERR_FILENO) == 0) return {};
  return [watch = Stopwatch()](double share) {
    std::fprintf(stderr, "\r%3.0f %%  about %.0f s left \033[K", 100 * share, watch.seconds() * (1 - share) / share);
    if (share >= 1) std::fputs("\r\033[K", stderr);
  };
}

int run_rig(const LabOptions& options) {
  const lab::Rig& rig = lab::find_rig(options.rig);
  if (!options.json.empty()) require_writable(options.json);
  device::Device device(options.device);
  lab::Setup setup = lab::default_setup(rig, device);
  setup.soil = chosen_soil(options, setup.soil);
  if (options.cell) setup.cell = *options.cell;
  for (const auto& [name, value] : options.geometry) setup.geometry[name] = value;
  setup.progress = progress_line(options.quiet);
  lab::check(rig, setup);
  const lab::Report report = rig.run(setup);
  std::printf("%s: %s\n", rig.name.c_str(), rig.summary.c_str());
  print_table(report);
  if (!options.json.empty()) write_file_atomically(options.json, to_json(rig, setup, report).dump(1) + "\n");
  return kOk;
}

/// Names an option that the rig does not have, with the nearest that it has.
[[noreturn]] void refuse(const CLI::App& command, const std::string& extra) {
  std::string best;
  std::size_t least = static_cast<std::size_t>(-1);
  const std::string name = extra.substr(0, extra.find('='));
  for (const CLI::Option* option : command.get_options()) {
    const std::string known = option->get_name();
    const std::size_t distance = edit_distance(known, name);
    if (distance < least) least = distance, best = known;
  }
  throw InputError(Fault{Fault::Severity::kError, "", 0, "lab " + command.get_name(), extra,
                         "an option of this rig (`navvy lab " + command.get_name() + " --help`)",
                         "did you mean '" + best + "'?"});
}

void add_rig(CLI::App& parent, const lab::Rig& rig, const std::shared_ptr<LabOptions>& options, Action& action) {
  CLI::App* command = parent.add_subcommand(rig.name, rig.summary);
  command->footer("\n" + wrapped(rig.drawing));
  command->allow_extras();
  for (const lab::Parameter& parameter : rig.parameters) {
    command
        ->add_option_function<double>(
            "--" + parameter.name,
            [options, name = parameter.name](const double& value) { options->geometry[name] = value; },
            parameter.help + (parameter.unit.empty() ? "" : " [" + parameter.unit + "]"))
        ->default_str(text_of(parameter.value))
        ->group("Geometry and procedure");
  }
  command->add_option("--soil", options->soil, "a soil of terrain/soils by name (`navvy soils`)")->group("Soil");
  for (SoilOption& value : options->soil_values)
    command->add_option(value.name, value.value, value.help)->group("Soil");
  command
      ->add_option("--set", options->settings,
                   "NAME=VALUE: any number of the soil by its name in scene files, as opening_strain=0.02; repeatable")
      ->group("Soil");
  command->add_option("--cell", options->cell, "edge of a soil cell [m]")
      ->check(above_zero)
      ->default_str(text_of(rig.default_cell));
  command->add_option("--device", options->device,
                      "OpenCL device: cpu, gpu, an index or a part of a name; without it NAVVY_DEVICE decides");
  command->add_option("--json", options->json, "write inputs, results and series to this file");
  command->add_flag("--quiet", options->quiet, "no progress line");
  command->callback([command, options, &action, name = rig.name] {
    options->rig = name;
    action = [command, options] {
      for (const std::string& extra : command->remaining()) refuse(*command, extra);
      return run_rig(*options);
    };
  });
}

}  // namespace

void add_lab(CLI::App& app, Action& action) {
  auto options = std::make_shared<LabOptions>();
  CLI::App* command = app.add_subcommand("lab", "virtual soil laboratory: one experiment, measured against theory");
  command->require_subcommand(0, 1);
  command->allow_extras();
  for (const lab::Rig& rig : lab::rigs()) add_rig(*command, rig, options, action);
  command->callback([command, &action] {
    if (!command->get_subcommands().empty()) return;
    const std::vector<std::string> extras = command->remaining();
    action = [extras] {
      if (!extras.empty()) lab::find_rig(extras.front());
      return list_rigs();
    };
  });
}

}  // namespace navvy::cli
