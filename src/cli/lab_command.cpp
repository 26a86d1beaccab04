// SPDX-License-Identifier: Apache-2.0
// `navvy lab`: one experiment on soil, its result as a table and as JSON.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "cli/commands.h"
#include "cli/exit_code.h"
#include "cli/lab_output.h"
#include "cli/validators.h"
#include "core/edit_distance.h"
#include "core/error.h"
#include "core/file.h"
#include "core/math.h"
#include "device/device.h"
#include "lab/rig.h"
#include "lab/soils.h"
#include "lab/sweep.h"
#include "scene/soil_values.h"
#include "scene_io/loader.h"
#include "scene_io/shipped.h"

namespace navvy::cli {
namespace {

/// One soil value that may be given by itself, in the unit that its name says.
struct SoilOption {
  const char* name;
  const char* help;
  double scene::Soil::*value;      ///< null for the two that set more than one number or another one
  double factor = 1;               ///< of what is given, for SI
  std::vector<double> given = {};  ///< more than one: an axis of a sweep
};

constexpr double kDegree = kPi / 180;

/// What a person wrote; soil and geometry are worked out only when the command runs, so that a fault of one is not
/// hidden behind a fault of the other in the parser.
struct LabOptions {
  std::string rig, device, json, plot, soil;
  std::vector<double> cell;                     ///< more than one: an axis of a sweep
  std::map<std::string, std::string> geometry;  ///< by Parameter::name, as written
  std::vector<SoilOption> soil_values = {
      {"--phi-deg", "friction angle phi (plane strain) [deg]", &scene::Soil::friction_angle, kDegree},
      {"--repose-deg", "angle of repose t instead of phi: sin phi = tan t [deg]", nullptr, kDegree},
      {"--cohesion-pa", "cohesion c, residual cohesion too unless the soil's is lower [Pa]", nullptr},
      {"--density", "bank density [kg/m3]", &scene::Soil::bank_density},
      {"--young-pa", "Young's modulus, softened for speed; 200 x cohesion where that is more and none is given [Pa]",
       &scene::Soil::young_modulus},
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
  bool quiet = false, energy = false;
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
    if (name == option.name && !option.given.empty()) return option.given.front() * option.factor;
  return lab::kNone;
}

/// The rig's soil, or a shipped one, changed as the options say; later kinds of option win over earlier ones.
scene::Soil chosen_soil(const LabOptions& options, scene::Soil soil) {
  if (!options.soil.empty()) soil = scene_io::shipped_soil(options.soil, "--soil");
  // An angle of repose first: a phi given beside it wins.
  const double cohesion_before = soil.cohesion, residual_before = soil.residual_cohesion;
  const double repose = given(options, "--repose-deg"), cohesion = given(options, "--cohesion-pa");
  if (!std::isnan(repose)) soil.friction_angle = lab::friction_from_repose(repose);
  if (!std::isnan(cohesion)) {
    const double before = std::exchange(soil.cohesion, cohesion);
    // A residual cohesion that was the whole one follows it, and it is never more than the whole one.
    if (cohesion != before && (soil.residual_cohesion == before || soil.residual_cohesion > cohesion))
      soil.residual_cohesion = cohesion;
  }
  for (const SoilOption& option : options.soil_values)
    if (option.value != nullptr && !option.given.empty()) soil.*option.value = option.given.front() * option.factor;
  for (const std::string& setting : options.settings) set_value(soil, setting);
  const auto is_set = [&](const std::string& name) {
    return std::any_of(options.settings.begin(), options.settings.end(),
                       [&](const std::string& setting) { return setting.rfind(name, 0) == 0; });
  };
  if (!is_set("loose_cohesion_pa")) scene::follow_residual_cohesion(soil, residual_before);
  if (!is_set("young_modulus_pa") && std::isnan(given(options, "--young-pa")))
    scene::follow_cohesion(soil, cohesion_before);
  return soil;
}

/// Shortest text that reads back as the same number.
std::string exact_text(double value) {
  std::array<char, 32> text{};
  return {text.data(), std::to_chars(text.data(), text.data() + text.size(), value).ptr};
}

/// Every option that was given as a list, and where its values go.
struct Lists {
  std::vector<lab::SweepAxis> axes;
  std::vector<std::function<void(LabOptions&, double)>> put;
};

Lists lists_of(const LabOptions& options, const lab::Rig& rig) {
  Lists out;
  // In the rig's own order: the first one is what the picture is drawn over.
  for (const lab::Parameter& parameter : rig.parameters) {
    const std::string& name = parameter.name;
    const auto given = options.geometry.find(name);
    if (given == options.geometry.end()) continue;
    const std::vector<std::string> parts = lab::listed("lab " + rig.name + " --" + name, given->second);
    if (parts.size() < 2) continue;
    lab::SweepAxis axis{name, parameter.unit, {}};
    for (const std::string& part : parts) {
      const std::optional<double> value = parameter.read(part);
      if (!value) throw refused("lab " + rig.name + " --" + name, part, parameter.rule(), "");
      axis.values.push_back(*value);
    }
    out.axes.push_back(axis);
    out.put.emplace_back([name](LabOptions& one, double value) { one.geometry[name] = exact_text(value); });
  }
  if (options.cell.size() > 1) {
    out.axes.push_back({"cell", "m", options.cell});
    out.put.emplace_back([](LabOptions& one, double value) { one.cell = {value}; });
  }
  for (std::size_t i = 0; i < options.soil_values.size(); ++i) {
    if (options.soil_values[i].given.size() < 2) continue;
    out.axes.push_back({std::string(options.soil_values[i].name).substr(2), "", options.soil_values[i].given});
    out.put.emplace_back([i](LabOptions& one, double value) { one.soil_values[i].given = {value}; });
  }
  return out;
}

/// The setup of one run: every option has one value.
lab::Setup setup_of(const LabOptions& options, const lab::Rig& rig, device::Device& device) {
  lab::Setup setup = lab::default_setup(rig, device);
  setup.soil = chosen_soil(options, setup.soil);
  if (!options.cell.empty()) setup.cell = options.cell.front();
  lab::set_written(setup, options.geometry);
  setup.energy = options.energy;
  setup.progress = progress_line(options.quiet);
  return setup;
}

/// Runs every combination of the lists, or the one experiment. A missed gate is a result like any other, but scripts
/// want to know: it has a status of its own.
int run_rig(const LabOptions& options) {
  const lab::Rig& rig = lab::find_rig(options.rig);
  // Before the runs, which may take an hour.
  for (const std::string& file : {options.json, options.plot})
    if (!file.empty()) require_writable(file);
  device::Device device(options.device);
  const Lists lists = lists_of(options, rig);
  if (!options.plot.empty() && lists.axes.empty())
    throw refused("lab " + rig.name + " --plot", options.plot, "drawn over a list of values",
                  "give some option more than one, as --cell 0.1,0.05");
  const std::vector<std::vector<double>> places = lab::combinations(lists.axes);
  std::vector<lab::Setup> setups;
  for (const std::vector<double>& at : places) {
    LabOptions one = options;
    for (std::size_t i = 0; i < at.size(); ++i) lists.put[i](one, at[i]);
    // All of them are checked before the first one runs.
    setups.push_back(setup_of(one, rig, device));
    lab::check(rig, setups.back());
  }
  lab::Sweep sweep{lists.axes, {}};
  nlohmann::json runs = nlohmann::json::array();
  bool missed = false;
  std::printf("%s: %s\n", rig.name.c_str(), rig.summary.c_str());
  for (std::size_t i = 0; i < setups.size(); ++i) {
    sweep.runs.push_back({places[i], rig.run(setups[i])});
    runs.push_back(to_json(rig, setups[i], sweep.runs.back().report));
    missed = missed || sweep.runs.back().report.missed();
  }
  if (lists.axes.empty())
    print_table(sweep.runs.front().report);
  else
    std::fputs(lab::text_of(lab::table_of(rig, sweep)).c_str(), stdout);
  if (!options.json.empty())
    write_file_atomically(options.json, (lists.axes.empty() ? runs.front() : runs).dump(1) + "\n");
  if (!options.plot.empty()) write_file_atomically(options.plot, lab::svg_of(lab::plot_of(rig, sweep)));
  return missed ? kGateMissed : kOk;
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
    command->add_option(value.name, value.given, described(value.help))
        ->delimiter(',')
        ->allow_extra_args(false)
        ->group("Soil");
  command
      ->add_option("--set", options->settings,
                   described("NAME=VALUE: any number of the soil by its name in scene files, as opening_strain=0.02; "
                             "repeatable"))
      ->group("Soil");
  command->add_option("--cell", options->cell, "edge of a soil cell [m]")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->check(above_zero)
      ->default_str(lab::short_text(rig.default_cell));
  command->add_option("--device", options->device,
                      described("OpenCL device: cpu, gpu, an index or a part of a name; without it NAVVY_DEVICE "
                                "decides"));
  command->add_option("--json", options->json, "write inputs, results and series to this file");
  command->add_option("--plot", options->plot,
                      described("draw the first result over the first list to this SVG file; any number takes a list, "
                                "as --speed 0.05,0.15 --cell 0.1,0.05: every combination is run, in one table"));
  command->add_flag("--energy", options->energy,
                    described("also tell where the soil's energy came from and went; takes up to three times as long"));
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
