// SPDX-License-Identifier: Apache-2.0
// `navvy lab`: one experiment on soil, its result as a table and as JSON.
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "cli/commands.h"
#include "cli/exit_code.h"
#include "cli/validators.h"
#include "core/edit_distance.h"
#include "core/error.h"
#include "core/file.h"
#include "core/math.h"
#include "core/stopwatch.h"
#include "device/device.h"
#include "lab/rig.h"
#include "lab/soils.h"
#include "scene/soil_values.h"
#include "scene_io/loader.h"

namespace navvy::cli {
namespace {

/// One soil value that may be given by itself, in the unit that its name says.
struct SoilOption {
  const char* name;
  const char* help;
  double scene::Soil::*value;  ///< null for the two that set more than one number or another one
  double factor = 1;           ///< of what is given, for SI
  std::optional<double> given = {};
};

constexpr double kDegree = kPi / 180;

/// What a person wrote; soil and geometry are worked out only when the command runs, so that a fault of one is not
/// hidden behind a fault of the other in the parser.
struct LabOptions {
  std::string rig, device, json, soil;
  std::optional<double> cell;
  std::map<std::string, std::string> geometry;  ///< by Parameter::name, as written
  std::vector<SoilOption> soil_values = {
      {"--phi-deg", "friction angle phi (plane strain) [deg]", &scene::Soil::friction_angle, kDegree},
      {"--repose-deg", "angle of repose t instead of phi: sin phi = tan t [deg]", nullptr, kDegree},
      {"--cohesion-pa", "cohesion c, residual cohesion too unless the soil's is lower [Pa]", nullptr},
      {"--density", "bank density [kg/m3]", &scene::Soil::bank_density},
      {"--young-pa", "Young's modulus, softened for speed [Pa]", &scene::Soil::young_modulus},
      {"--poisson", "Poisson's ratio [-]", &scene::Soil::poisson},
      {"--swell", "loose volume / bank volume [-]", &scene::Soil::swell},
      {"--dilatancy-deg", "dilatancy angle psi in bank state [deg]; needs a swell", &scene::Soil::dilatancy_angle,
       kDegree},
      {"--fast-phi-deg", "mu(I): friction angle of fast flow [deg]", &scene::Soil::fast_friction_angle, kDegree},
      {"--grain-m", "mu(I): grain diameter [m]", &scene::Soil::grain_diameter},
      {"--inertial-number", "mu(I): inertial number at half the growth [-]", &scene::Soil::inertial_number},
      {"--delta-deg", "friction angle of soil on tool [deg]", &scene::Soil::tool_friction_angle, kDegree},
      {"--adhesion-pa", "adhesion of soil on tool [Pa]", &scene::Soil::adhesion},
  };
  std::vector<std::string> settings;  ///< NAME=VALUE of scene::soil_values
  bool quiet = false;
};

constexpr std::size_t kWidth = 100;      ///< of the help [characters]
constexpr std::size_t kHelpColumn = 30;  ///< where the parser begins an option's description

constexpr char kJoint = '\x1f';  ///< in a text to be wrapped: a space at which no line may break

/// `text` with its spaces joined, to stay on one line.
std::string joined(std::string text) {
  std::replace(text.begin(), text.end(), ' ', kJoint);
  return text;
}

/// Breaks text between words; `between` stands between two lines and ends with the second one's indent.
std::string wrapped(const std::string& text, std::size_t width, const std::string& between = "\n") {
  std::string out;
  std::size_t column = 0, at = 0;
  while (at < text.size()) {
    const std::size_t end = std::min(text.find(' ', at), text.size());
    // A word longer than the line stands on a line of its own.
    if (column > 0 && column + 1 + end - at > width) {
      out += between;
      column = between.size() - between.find('\n') - 1;
    } else if (column > 0) {
      out += ' ';
      ++column;
    }
    out.append(text, at, end - at);
    column += end - at;
    at = end + 1;
  }
  std::replace(out.begin(), out.end(), kJoint, ' ');
  return out;
}

/// An option's description, broken so that it stays right of the parser's column of names.
std::string described(const std::string& text) { return wrapped(text, kWidth - kHelpColumn); }

int list_rigs() {
  std::puts(
      "The virtual soil laboratory. `navvy lab RIG` runs an experiment, `navvy lab RIG --help` draws it in words.\n");
  for (const lab::Rig& rig : lab::rigs()) std::printf("  %-12s %s\n", rig.name.c_str(), rig.summary.c_str());
  return kOk;
}

InputError refused(const std::string& where, const std::string& value, const std::string& rule,
                   const std::string& remedy) {
  return InputError(Fault{Fault::Severity::kError, "", 0, where, value, rule, remedy});
}

std::string did_you_mean(const std::vector<std::string>& names, const std::string& wanted) {
  return "did you mean '" + nearest_name(names, wanted) + "'?";
}

/// The shipped soil of this name. @throws InputError naming the nearest.
scene::Soil shipped_soil(const std::string& name) {
  const std::string directory = scene_io::find_data("terrain/soils");
  std::vector<std::string> names;
  if (!directory.empty())
    for (const scene::Soil& soil : scene_io::load_soils(directory)) {
      if (soil.name == name) return soil;
      names.push_back(soil.name);
    }
  // Without the data there is nothing to be near to: say how to find it.
  throw refused("--soil", name, "a soil that `navvy soils` lists",
                names.empty() ? "set NAVVY_DATA_DIR" : did_you_mean(names, name));
}

/// Sets a number of the soil by its name in scene files, in that file's unit.
void set_value(scene::Soil& soil, const std::string& setting) {
  const auto [name, text] = scene_io::parse_setting(setting);
  std::vector<std::string> names;
  for (const scene::SoilValue& value : scene::soil_values()) {
    names.emplace_back(value.name);
    if (name != value.name) continue;
    double number = 0;
    const char* end = text.data() + text.size();
    // All of the text must be the number: 0.02m is a mistake.
    const auto [stop, failed] = std::from_chars(text.data(), end, number);
    if (failed != std::errc() || stop != end) throw refused("--set " + name, text, "must be a number", "");
    soil.*value.value = number * value.factor;
    return;
  }
  throw refused("--set", name, "a number of a soil, by its name in scene files", did_you_mean(names, name));
}

/// The value given for an option in SI units; kNone when it was not given.
double given(const LabOptions& options, const std::string& name) {
  for (const SoilOption& option : options.soil_values)
    if (name == option.name && option.given) return *option.given * option.factor;
  return lab::kNone;
}

/// The rig's soil, or a shipped one, changed as the options say; later kinds of option win over earlier ones.
scene::Soil chosen_soil(const LabOptions& options, scene::Soil soil) {
  if (!options.soil.empty()) soil = shipped_soil(options.soil);
  // An angle of repose first: a phi given beside it wins.
  const double repose = given(options, "--repose-deg"), cohesion = given(options, "--cohesion-pa");
  if (!std::isnan(repose)) soil.friction_angle = lab::friction_from_repose(repose);
  if (!std::isnan(cohesion)) {
    const double before = std::exchange(soil.cohesion, cohesion);
    // A residual cohesion that was the whole one follows it, and it is never more than the whole one.
    if (cohesion != before && (soil.residual_cohesion == before || soil.residual_cohesion > cohesion))
      soil.residual_cohesion = cohesion;
  }
  for (const SoilOption& option : options.soil_values)
    if (option.value != nullptr && option.given) soil.*option.value = *option.given * option.factor;
  for (const std::string& setting : options.settings) set_value(soil, setting);
  return soil;
}

/// "farthest motion", "mm" -> "farthest_motion_mm".
/// Keys of the JSON name the quantity and its unit, as scene files do:
std::string key(const std::string& name, const std::string& unit) {
  std::string out;
  for (const char c : unit.empty() ? name : name + "_" + unit)
    out += std::isalnum(static_cast<unsigned char>(c)) != 0 ? c : c == '%' ? 'p' : '_';
  return out;
}

/// JSON knows no NaN: a quantity that could not be measured is null.
nlohmann::json number(double value) { return std::isfinite(value) ? nlohmann::json(value) : nlohmann::json(nullptr); }

/// Every number under its name in scene files.
nlohmann::json soil_json(const scene::Soil& soil) {
  nlohmann::json out = {{"name", soil.name}, {"source", soil.source}};
  for (const scene::SoilValue& v : scene::soil_values()) out[v.name] = v.written(soil);
  return out;
}

/// Inputs first, so that a file says by itself what it is the result of.
nlohmann::json to_json(const lab::Rig& rig, const lab::Setup& setup, const lab::Report& report) {
  nlohmann::json out;
  out["rig"] = rig.name;
  out["version"] = NAVVY_VERSION;
  // Results are repeatable bit for bit on one device only, so the device is part of them.
  out["device"] = setup.device->info().text();
  nlohmann::json& inputs = out["inputs"];
  inputs["soil"] = soil_json(setup.soil);
  inputs["cell_m"] = setup.cell;
  for (const lab::Parameter& p : rig.parameters) inputs["geometry"][key(p.name, p.unit)] = setup[p.name];
  for (const lab::Quantity& q : report.results) {
    const std::string name = key(q.name, q.unit);
    out["result"][name] = number(q.measured);
    out["expected"][name] = number(q.expected);
    // Absent where there is none, so that a reader need not tell a gate of nulls from no gate.
    if (q.has_gate()) out["gate"][name] = {number(q.low), number(q.high)};
    if (!q.source.empty()) out["source"][name] = q.source;
    if (q.missed()) out["missed"].push_back(name);
    // Of a gate that says nothing here: what it holds for.
    if (!q.in_range) out["not_judged"][name] = q.range;
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

/// Empty where there is no number.
std::string text_of(double value) { return std::isnan(value) ? "" : lab::short_text(value); }

/// Results for a person: five digits, misses marked, how the run went in the lines below. A gate that holds for other
/// setups only is told with what it holds for.
void print_table(const lab::Report& report) {
  std::printf("%-40s %14s %12s %-22s %s\n", "quantity", "measured", "expected", "gate", "source");
  for (const lab::Quantity& q : report.results) {
    const std::string gate = q.has_gate() ? text_of(q.low) + " .. " + text_of(q.high) : "";
    std::printf("%-40s %14s %12s %-22s %s\n", (q.name + (q.unit.empty() ? "" : " [" + q.unit + "]")).c_str(),
                (std::isnan(q.measured) ? "nan" : text_of(q.measured)).c_str(), text_of(q.expected).c_str(),
                (gate + (q.missed()   ? "  MISS"
                         : q.in_range ? ""
                                      : "  not judged"))
                    .c_str(),
                q.source.c_str());
  }
  for (const lab::Quantity& q : report.results)
    if (!q.in_range) std::printf("not judged: %s; its gate holds for %s\n", q.name.c_str(), q.range.c_str());
  std::printf("%d particles, %llu steps, %.2f s simulated in %.1f s; ledger %lld, hash %s\n", report.particles_peak,
              static_cast<unsigned long long>(report.steps), report.simulated_time, report.wall_time,
              static_cast<long long>(report.ledger_error), report.state_hash.c_str());
}

/// A line on a terminal with the share done; nothing when stderr is a file or pipe.
std::function<void(double)> progress_line(bool quiet) {
  if (quiet || isatty(STDERR_FILENO) == 0) return {};
  // Carriage return and clearing code keep it one line; the last call wipes it.
  return [watch = Stopwatch()](double share) {
    std::fprintf(stderr, "\r%3.0f %%  about %.0f s left \033[K", 100 * share, watch.seconds() * (1 - share) / share);
    if (share >= 1) std::fputs("\r\033[K", stderr);
  };
}

/// Runs the experiment. A missed gate is a result like any other, but scripts want to know: it has a status of its own.
int run_rig(const LabOptions& options) {
  const lab::Rig& rig = lab::find_rig(options.rig);
  // Before the run, which may take an hour.
  if (!options.json.empty()) require_writable(options.json);
  device::Device device(options.device);
  lab::Setup setup = lab::default_setup(rig, device);
  setup.soil = chosen_soil(options, setup.soil);
  if (options.cell) setup.cell = *options.cell;
  lab::set_written(setup, options.geometry);
  setup.progress = progress_line(options.quiet);
  const lab::Report report = rig.run(setup);
  std::printf("%s: %s\n", rig.name.c_str(), rig.summary.c_str());
  print_table(report);
  if (!options.json.empty()) write_file_atomically(options.json, to_json(rig, setup, report).dump(1) + "\n");
  return report.missed() ? kGateMissed : kOk;
}

/// Names an option that the rig does not have, with the nearest that it has.
[[noreturn]] void refuse(const CLI::App& command, const std::string& extra) {
  std::vector<std::string> names;
  for (const CLI::Option* option : command.get_options()) names.push_back(option->get_name());
  throw refused("lab " + command.get_name(), extra,
                "an option of this rig (`navvy lab " + command.get_name() + " --help`)",
                did_you_mean(names, extra.substr(0, extra.find('='))));
}

/// What the help says of a parameter: all of it follows from the parameter itself.
std::string description(const lab::Parameter& parameter) {
  std::string out = parameter.help + (parameter.unit.empty() ? "" : " [" + parameter.unit + "]");
  for (const lab::Choice& choice : parameter.choices)
    out += (out.empty() ? "" : "; ") + choice.word + ": " + choice.help;
  const bool limited = parameter.range.text() != lab::any().text();
  if (parameter.choices.empty() && limited) out += "; " + joined(parameter.range.text());
  return out;
}

/// What may stand behind the option's name.
std::string type_name(const lab::Parameter& parameter) {
  std::string out;
  for (const lab::Choice& choice : parameter.choices) out += (out.empty() ? "" : "|") + choice.word;
  return !out.empty() ? out : parameter.range.whole ? "INT" : "FLOAT";
}

/// Arguments of an example with every option joined to its value.
std::string in_pairs(std::string arguments) {
  arguments = joined(std::move(arguments));
  for (std::size_t at = 0; (at = arguments.find(kJoint + std::string("--"), at)) != std::string::npos;)
    arguments[at] = ' ';
  return arguments;
}

/// The rig in words and the ways of running it, below the options. A command's lines end as a shell wants them, ready
/// to be copied.
std::string footer(const lab::Rig& rig) {
  std::string out = "\n" + wrapped(rig.drawing, kWidth);
  for (const lab::Example& example : rig.examples)
    out += "\n\n" + wrapped(example.what + ":", kWidth) + "\n  " +
           wrapped("navvy lab " + rig.name + " " + in_pairs(example.arguments), kWidth - 4, " \\\n    ");
  return out;
}

void add_rig(CLI::App& parent, const lab::Rig& rig, const std::shared_ptr<LabOptions>& options, Action& action) {
  CLI::App* command = parent.add_subcommand(rig.name, rig.summary);
  command->footer(footer(rig));
  // An unknown option is refused by us, with the nearest known one.
  command->allow_extras();
  for (const lab::Parameter& parameter : rig.parameters)
    command
        ->add_option_function<std::string>(
            "--" + parameter.name,
            [options, name = parameter.name](const std::string& written) { options->geometry[name] = written; },
            described(description(parameter)))
        ->type_name(type_name(parameter))
        ->default_str(parameter.text(parameter.value))
        ->group("Geometry and procedure");
  command->add_option("--soil", options->soil, "a soil of terrain/soils by name (`navvy soils`)")->group("Soil");
  // All rigs share the options of the soil; only one rig is run.
  for (SoilOption& value : options->soil_values)
    command->add_option(value.name, value.given, described(value.help))->group("Soil");
  command
      ->add_option("--set", options->settings,
                   described("NAME=VALUE: any number of the soil by its name in scene files, as opening_strain=0.02; "
                             "repeatable"))
      ->group("Soil");
  command->add_option("--cell", options->cell, "edge of a soil cell [m]")
      ->check(above_zero)
      ->default_str(lab::short_text(rig.default_cell));
  command->add_option("--device", options->device,
                      described("OpenCL device: cpu, gpu, an index or a part of a name; without it NAVVY_DEVICE "
                                "decides"));
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
  // Shared with the callbacks, which run after this function has returned.
  auto options = std::make_shared<LabOptions>();
  CLI::App* command = app.add_subcommand("lab", "virtual soil laboratory: one experiment, measured against theory");
  command->require_subcommand(0, 1);
  command->allow_extras();
  for (const lab::Rig& rig : lab::rigs()) add_rig(*command, rig, options, action);
  command->callback([command, &action] {
    if (!command->get_subcommands().empty()) return;
    const std::vector<std::string> extras = command->remaining();
    // `navvy lab` alone lists the rigs; a word behind it that is no rig is refused with the nearest.
    action = [extras] {
      if (!extras.empty()) lab::find_rig(extras.front());
      return list_rigs();
    };
  });
}

}  // namespace navvy::cli
