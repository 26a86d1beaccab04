// SPDX-License-Identifier: Apache-2.0
// `navvy lab`: runs experiments on soil and prints their results as a table or JSON.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <utility>

#include "cli/commands.h"
#include "cli/exit_code.h"
#include "cli/lab_output.h"
#include "cli/progress_line.h"
#include "cli/validators.h"
#include "core/edit_distance.h"
#include "core/error.h"
#include "core/file.h"
#include "core/log.h"
#include "device/device.h"
#include "lab/experiment.h"
#include "lab/rig.h"
#include "lab/sweep.h"
#include "scene_io/loader.h"
#include "scene_io/shipped.h"
#include "soil/scheme.h"

namespace navvy::cli {
namespace {

/// Options as parsed. Soil and geometry are evaluated when the command runs, so that faults of one
/// do not hide those of the other.
struct LabOptions {
  std::string rig, device, json, plot, soil;
  lab::Experiment experiment;
  std::vector<std::string> settings;  ///< NAME=VALUE
  bool quiet = false;
};

/// Width of the help [characters].
constexpr std::size_t kWidth = 100;
/// Column at which the parser begins the description of an option.
constexpr std::size_t kHelpColumn = 30;

/// Subcommand that lists constants.
constexpr const char* kConstants = "constants";

/// Stands for a space at which no line may break.
constexpr char kJoint = '\x1f';

/// Returns `text` with spaces at which no line may break.
std::string joined(std::string text) {
  std::replace(text.begin(), text.end(), ' ', kJoint);
  return text;
}

/// Breaks text between words. `between` separates two lines and contains the indent of the second.
std::string wrapped(const std::string& text, std::size_t width, const std::string& between = "\n") {
  std::string out;
  std::size_t column = 0, at = 0;
  while (at < text.size()) {
    const std::size_t end = std::min(text.find(' ', at), text.size());
    // A word that is too long gets a line of its own.
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

/// Returns the description of an option, wrapped to the right of the column of names.
std::string described(const std::string& text) { return wrapped(text, kWidth - kHelpColumn); }

/// Prints a line for each rig and each rating, in the order of the subcommands.
int list_rigs(const CLI::App& command) {
  std::puts(
      "Virtual soil laboratory. `navvy lab RIG` runs an experiment, `navvy lab RIG --help` "
      "describes it.\n");
  for (const CLI::App* one : command.get_subcommands([](const CLI::App*) { return true; }))
    if (one->get_name() != kConstants)
      std::printf("  %-12s %s\n", one->get_name().c_str(), one->get_description().c_str());
  std::puts(
      "\n`navvy lab constants` lists the constants of the particle scheme, which --set "
      "scheme.NAME=VALUE changes.");
  return kOk;
}

/// Returns the error for an option of the laboratory.
InputError refused(const std::string& where, const std::string& value, const std::string& rule,
                   const std::string& remedy) {
  return InputError(Fault{Fault::Severity::kError, "", 0, where, value, rule, remedy});
}

std::string did_you_mean(const std::vector<std::string>& names, const std::string& wanted) {
  return "did you mean '" + nearest_name(names, wanted) + "'?";
}

/// Prints the constants of the particle scheme: name, default, unit, range, description.
int list_constants() {
  std::puts(
      "Constants of the particle scheme; `navvy lab RIG --set scheme.NAME=VALUE` changes one.\n");
  for (const soil::SchemeConstant& row : soil::scheme_constants()) {
    std::printf("  %-28s %-10s %-18s %s .. %s\n", row.name, lab::short_text(row.standard()).c_str(),
                row.unit, lab::short_text(row.low).c_str(), lab::short_text(row.high).c_str());
    std::printf("      %s\n", row.help);
  }
  return kOk;
}

/// Runs all combinations of the lists, or the one experiment. Results outside their tolerance give
/// an exit status of their own, for scripts.
int run_rig(LabOptions options) {
  const lab::Rig& rig = lab::find_rig(options.rig);
  // The runs may take an hour, so the files are checked first.
  for (const std::string& file : {options.json, options.plot})
    if (!file.empty()) require_writable(file);
  device::Device device(options.device);
  lab::Experiment& experiment = options.experiment;
  if (!options.soil.empty()) experiment.soil = scene_io::shipped_soil(options.soil, "--soil");
  for (const std::string& setting : options.settings)
    experiment.settings.push_back(scene_io::parse_setting(setting));
  experiment.progress = progress_line(options.quiet);
  // All runs are checked before the first one starts.
  lab::ExperimentPlan plan = lab::plan_of(rig, experiment, device);
  if (!options.plot.empty() && plan.axes.empty())
    throw refused("lab " + rig.name + " --plot", options.plot, "drawn over a list of values",
                  "give some option more than one, as --cell 0.1,0.05");
  lab::Sweep sweep{plan.axes, {}};
  nlohmann::json runs = nlohmann::json::array();
  bool outside = false;
  std::printf("%s: %s\n", rig.name.c_str(), rig.summary.c_str());
  for (const lab::PlannedRun& one : plan.runs) {
    sweep.runs.push_back({one.at, rig.run(one.setup)});
    runs.push_back(to_json(rig, one.setup, sweep.runs.back().report));
    outside = outside || sweep.runs.back().report.outside_tolerance();
  }
  // One experiment gets a table of its results, a sweep a table of its runs.
  if (plan.axes.empty())
    print_table(sweep.runs.front().report);
  else
    std::fputs(lab::text_of(lab::table_of(rig, sweep)).c_str(), stdout);
  if (!options.json.empty())
    write_file_atomically(options.json, (plan.axes.empty() ? runs.front() : runs).dump(1) + "\n");
  if (!options.plot.empty())
    write_file_atomically(options.plot, lab::svg_of(lab::plot_of(rig, sweep)));
  return outside ? kOutOfTolerance : kOk;
}

/// Refuses a word that is no rig, and names the nearest.
[[noreturn]] void refuse_rig(const CLI::App& command, const std::string& word) {
  std::vector<std::string> names;
  for (const CLI::App* one : command.get_subcommands([](const CLI::App*) { return true; }))
    names.push_back(one->get_name());
  throw refused("lab", word, "there is no rig of this name", did_you_mean(names, word));
}

/// Refuses an option that the rig does not have, and names the nearest.
[[noreturn]] void refuse(const CLI::App& command, const std::string& extra) {
  std::vector<std::string> names;
  for (const CLI::Option* option : command.get_options()) names.push_back(option->get_name());
  throw refused("lab " + command.get_name(), extra,
                "an option of this rig (`navvy lab " + command.get_name() + " --help`)",
                did_you_mean(names, extra.substr(0, extra.find('='))));
}

/// Returns the help text of a parameter, which follows from its declaration.
std::string description(const lab::Parameter& parameter) {
  std::string out = parameter.help + (parameter.unit.empty() ? "" : " [" + parameter.unit + "]");
  for (const lab::Choice& choice : parameter.choices)
    out += (out.empty() ? "" : "; ") + choice.word + ": " + choice.help;
  const bool limited = parameter.range.text() != lab::any().text();
  if (parameter.choices.empty() && limited) out += "; " + joined(parameter.range.text());
  return out;
}

/// Returns the type of an option's value for the help.
std::string type_name(const lab::Parameter& parameter) {
  std::string out;
  for (const lab::Choice& choice : parameter.choices) out += (out.empty() ? "" : "|") + choice.word;
  return !out.empty() ? out : parameter.range.whole ? "INT" : "FLOAT";
}

/// Joins each option of an example with its value, so that no line breaks between them.
std::string in_pairs(std::string arguments) {
  arguments = joined(std::move(arguments));
  for (std::size_t at = 0;
       (at = arguments.find(kJoint + std::string("--"), at)) != std::string::npos;)
    arguments[at] = ' ';
  return arguments;
}

/// Returns the description and examples of a rig, for the end of its help. Examples are wrapped
/// with the shell's continuation, ready to be copied.
std::string footer(const lab::Rig& rig) {
  std::string out = "\n" + wrapped(rig.drawing, kWidth);
  for (const lab::Example& example : rig.examples)
    out += "\n\n" + wrapped(example.what + ":", kWidth) + "\n  " +
           wrapped("navvy lab " + rig.name + " " + in_pairs(example.arguments), kWidth - 4,
                   " \\\n    ");
  return out;
}

/// Adds the subcommand of a rig. Its options follow from the declaration of its parameters.
// A list of options. NOLINTNEXTLINE(readability-function-size)
void add_rig(CLI::App& parent, const lab::Rig& rig, const std::shared_ptr<LabOptions>& options,
             Action& action) {
  CLI::App* command = parent.add_subcommand(rig.name, rig.summary);
  command->footer(footer(rig));
  // Unknown options are refused by `refuse`, with the nearest name.
  command->allow_extras();
  for (const lab::Parameter& parameter : rig.parameters)
    command
        ->add_option_function<std::string>(
            "--" + parameter.name,
            [options, name = parameter.name](const std::string& written) {
              options->experiment.geometry[name] = written;
            },
            described(description(parameter)))
        ->type_name(type_name(parameter))
        ->default_str(parameter.text(parameter.value))
        ->group("Geometry and procedure");
  // Former names work for one release; a group without a name keeps them out of the help.
  for (const lab::Parameter& parameter : rig.parameters)
    if (!parameter.former.empty())
      command
          ->add_option_function<std::string>(
              "--" + parameter.former,
              [options, name = parameter.name,
               former = parameter.former](const std::string& written) {
                log_warning("lab: --" + former + " is now called --" + name);
                options->experiment.geometry[name] = written;
              })
          ->group("");
  command->add_option("--soil", options->soil, "a soil of terrain/soils by name (`navvy soils`)")
      ->group("Soil");
  // All rigs share the options of the soil, as only one rig runs.
  for (const lab::SoilOption& value : lab::soil_options())
    command
        ->add_option(std::string("--") + value.name, options->experiment.soil_values[value.name],
                     described(value.help))
        ->delimiter(',')
        ->allow_extra_args(false)
        ->group("Soil");
  command
      ->add_option("--set", options->settings,
                   described("NAME=VALUE: any number of the soil by its name in scene files, as "
                             "opening_strain=0.02, or a "
                             "constant of the particle scheme, as scheme.mixing_strain=0.05 "
                             "(`navvy lab constants` "
                             "lists them); repeatable"))
      ->group("Soil");
  command->add_option("--cell", options->experiment.cells, "edge of a soil cell [m]")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->check(above_zero)
      ->default_str(lab::short_text(rig.default_cell));
  command->add_option(
      "--device", options->device,
      described("OpenCL device: cpu, gpu, an index or a part of a name; without it NAVVY_DEVICE "
                "decides"));
  command->add_option("--json", options->json, "write inputs, results and series to this file");
  command->add_option(
      "--plot", options->plot,
      described(
          "draw the first result over the first list to this SVG file; any number takes a list, "
          "as --speed 0.05,0.15 --cell 0.1,0.05: every combination is run, in one table"));
  command->add_flag(
      "--energy", options->experiment.energy,
      described("report the energy account of the soil; takes up to three times as long"));
  command->add_flag("--quiet", options->quiet, "no progress line");
  // All rigs share one set of options; the callback notes which of them was chosen.
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
  CLI::App* command =
      app.add_subcommand("lab", "virtual soil laboratory: one experiment, measured against theory");
  command->require_subcommand(0, 1);
  command->allow_extras();
  for (const lab::Rig& rig : lab::rigs()) add_rig(*command, rig, options, action);
  add_ratings(*command, action);
  add_motion_energy(*command, action);
  command->add_subcommand(kConstants, "list the constants of the particle scheme")
      ->callback([&action] { action = [] { return list_constants(); }; });
  command->callback([command, &action] {
    if (!command->get_subcommands().empty()) return;
    const std::vector<std::string> extras = command->remaining();
    // `navvy lab` alone lists the rigs. An unknown word is refused with the nearest name.
    action = [extras, command] {
      if (!extras.empty()) refuse_rig(*command, extras.front());
      return list_rigs(*command);
    };
  });
}

}  // namespace navvy::cli
