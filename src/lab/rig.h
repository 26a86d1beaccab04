// SPDX-License-Identifier: Apache-2.0
// Virtual soil laboratory. A rig simulates one laboratory apparatus and measures one property of
// the soil with it, as a geotechnical laboratory does.
#pragma once

#include <functional>
#include <map>
#include <string>
#include <vector>

#include "lab/parameter.h"
#include "lab/report.h"
#include "scene/soil.h"
#include "soil/scheme_constants.h"

namespace navvy::device {
class Device;
}

namespace navvy::lab {

struct Rig;

/// Inputs of one experiment. `geometry` holds a value for every parameter of the rig; default_setup
/// fills them in.
struct Setup {
  /// Rig that the parameters in `geometry` belong to; default_setup sets it. The rig must outlive
  /// this setup.
  const Rig* rig = nullptr;
  /// Device on which the soil solver runs; not owned. Must not be null when the rig runs.
  device::Device* device = nullptr;
  /// Soil that the rig tests.
  scene::Soil soil;
  /// Edge length of a cell of the soil grid [m].
  double cell = 0.1;
  /// Values of the rig's parameters, keyed by Parameter::name, each in Parameter::unit.
  std::map<std::string, double> geometry;
  /// Numerical constants of the particle method. Most experiments leave them at their defaults.
  soil::SchemeConstants scheme;
  /// If true, the report includes the soil's energy account; computing it slows the run down.
  bool energy = false;
  /// Callback for progress reports, called during the run with the completed share of the
  /// experiment, 0 to 1. May be empty.
  std::function<void(double share)> progress;

  /// Returns the value of the parameter `name`, in Parameter::unit.
  /// @throws InputError if the rig has no such parameter; the message names the most similar one.
  double operator[](const std::string& name) const;
  /// Returns the value of the parameter `name`, rounded to the nearest whole number: for counts.
  /// @throws InputError if the rig has no such parameter.
  int whole(const std::string& name) const;
  /// Returns true if the parameter `name` has the value that `word` stands for (Choice::word).
  /// @throws InputError if `word` is not one of the parameter's allowed words.
  bool is(const std::string& name, const std::string& word) const;
};

/// One example command line for a rig, most often that of a published experiment.
struct Example {
  /// One-line description of what the example reproduces.
  std::string what;
  /// Command-line arguments that follow `navvy lab RIG`.
  std::string arguments;
};

/// Description of one laboratory apparatus: help texts, parameters, defaults and the function that
/// runs an experiment.
struct Rig {
  /// Rig name on the command line: one word, or two words joined by '-'.
  std::string name;
  /// One-line description of the rig, for lists of rigs.
  std::string summary;
  /// Description of the rig in one paragraph: arrangement, motion and measured quantities.
  std::string drawing;
  /// Example command lines that the rig's help shows.
  std::vector<Example> examples;
  /// Parameters that the command line accepts, in the order in which the help lists them.
  std::vector<Parameter> parameters;
  /// Soil that the rig uses if the user gives none.
  scene::Soil default_soil;
  /// Cell size that the rig uses if the user gives none [m].
  double default_cell = 0.1;
  /// Function that runs the experiment and returns its report. Use `run` instead, which first
  /// checks the setup.
  Report (*experiment)(const Setup&) = nullptr;
  /// Names of the results that the table of a sweep shows (lab/sweep.h); its plot shows the first
  /// of them. If empty, both show the report's first result.
  std::vector<std::string> headline = {};
  /// Returns the rig's parameter of this name, or null if there is none.
  const Parameter* find(const std::string& parameter) const;

  /// Checks the setup, runs the experiment and returns its report. Blocks until the experiment is
  /// over.
  /// @throws InputError for a setup that `check` rejects.
  /// @throws SimulationError when the soil solver finds a value that is not finite, or lost mass.
  Report run(const Setup& setup) const;
};

/// Returns all rigs of the laboratory, in the order of the documentation.
const std::vector<Rig>& rigs();
/// Returns the rig of this name.
/// @throws InputError if there is none; the message names the rig with the most similar name.
const Rig& find_rig(const std::string& name);
/// Returns a setup of `rig` on `device` with the rig's default soil, cell size and parameter
/// values.
Setup default_setup(const Rig& rig, device::Device& device);
/// Sets parameters of `setup` from texts of the command line. `written` maps parameter names to
/// texts; each text is a number or one of the parameter's allowed words. Does not check ranges:
/// `check` does.
/// @throws InputError that lists every unknown name and every unreadable text, each with the most
/// similar valid one.
void set_written(Setup& setup, const std::map<std::string, std::string>& written);
/// Checks that every parameter value in `setup` is allowed for `rig` and that the soil is valid.
/// @throws InputError that lists every error, for parameters with rig, parameter, value, rule and
/// default.
void check(const Rig& rig, const Setup& setup);

}  // namespace navvy::lab
