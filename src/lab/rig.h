// SPDX-License-Identifier: Apache-2.0
// Virtual soil laboratory: rigs that measure one quantity of the soil, as a geotechnical laboratory
// does.
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

/// Inputs of one experiment. `geometry` holds every parameter of the rig (see default_setup).
struct Setup {
  /// Rig whose parameters these are.
  const Rig* rig = nullptr;
  /// Device to run on.
  device::Device* device = nullptr;
  /// Soil of the experiment.
  scene::Soil soil;
  /// Edge of a cell [m].
  double cell = 0.1;
  /// Values by Parameter::name.
  std::map<std::string, double> geometry;
  /// Constants of the particle method; defaults unless an experiment changes one.
  soil::SchemeConstants scheme;
  /// The report includes the soil's energy account, which takes time.
  bool energy = false;
  /// Called now and then with 0 .. 1; may be empty.
  std::function<void(double share)> progress;

  /// Returns a parameter's value.
  /// @throws InputError naming the nearest parameter when the rig has none of this name.
  double operator[](const std::string& name) const;
  /// Returns a parameter's value as a whole number, for counts.
  int whole(const std::string& name) const;
  /// Returns true if the choice `name` is the one of this word.
  /// @throws InputError for a word that is none of its choices.
  bool is(const std::string& name, const std::string& word) const;
};

/// A notable way to run a rig, mostly one published experiment.
struct Example {
  /// Description in one line.
  std::string what;
  /// Arguments of `navvy lab RIG`.
  std::string arguments;
};

/// One apparatus.
struct Rig {
  /// One word, or two joined by '-'.
  std::string name;
  /// One line.
  std::string summary;
  /// Description of the rig in one paragraph: arrangement, motion, readings.
  std::string drawing;
  std::vector<Example> examples;
  std::vector<Parameter> parameters;
  scene::Soil default_soil;
  /// [m].
  double default_cell = 0.1;
  /// Called by `run` after `check`.
  Report (*experiment)(const Setup&) = nullptr;
  /// Results that tables of many runs show (lab/sweep.h); the plot shows the first one.
  std::vector<std::string> headline = {};
  /// Returns null when there is none.
  const Parameter* find(const std::string& parameter) const;

  /// Checks the setup, then blocks until the experiment is over.
  /// @throws InputError for a setup that makes no sense.
  /// @throws SimulationError when the soil stops itself.
  Report run(const Setup& setup) const;
};

/// Returns all rigs, in the order of the documentation.
const std::vector<Rig>& rigs();
/// Returns a rig by its name.
/// @throws InputError naming the nearest rig.
const Rig& find_rig(const std::string& name);
/// Returns a setup with default soil, cell and geometry.
Setup default_setup(const Rig& rig, device::Device& device);
/// Sets parameters from text: numbers, or the words of choices. Ranges are left to `check`.
/// @throws InputError with every name that the rig does not have and every text that is no value,
/// each with the nearest that is.
void set_written(Setup& setup, const std::map<std::string, std::string>& written);
/// Checks ranges and choices of all parameters, and the soil.
/// @throws InputError with every fault: rig, parameter, value, rule, and its default.
void check(const Rig& rig, const Setup& setup);

}  // namespace navvy::lab
