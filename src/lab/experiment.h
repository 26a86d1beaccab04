// SPDX-License-Identifier: Apache-2.0
// An experiment as a user requests it (soil, changes and parameter lists), and the plan of runs
// that carries it out.
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "lab/rig.h"
#include "lab/sweep.h"
#include "scene/soil.h"

namespace navvy::lab {

/// A command-line option that changes one value of the soil.
struct SoilOption {
  /// Option name without dashes; most end in the unit of the value, as in "phi-deg".
  const char* name;
  /// One-line help text that ends with the unit in brackets.
  const char* help;
  /// Soil member that the option sets; null if setting it takes more than an assignment (soil_of
  /// does it).
  double scene::Soil::*value;
  /// Factor from the option's unit to SI units: SI value = given value x factor.
  double factor = 1;
};

/// Returns all command-line options that change the soil, in the order of the help.
const std::vector<SoilOption>& soil_options();

/// An experiment as the user requests it: a soil, changes to the soil, and parameter values of the
/// rig. Where more than one value is given for a quantity, the quantity becomes an axis of a sweep.
struct Experiment {
  /// Soil to start from; if empty, the rig's default soil.
  std::optional<scene::Soil> soil;
  /// Values of soil options, keyed by SoilOption::name, in the unit of the option. More than one
  /// value makes a sweep axis.
  std::map<std::string, std::vector<double>> soil_values;
  /// Pairs of name and number, both as text. The name is either a soil value as scene files call it
  /// (scene/soil_values.h), with the number in the unit of scene files, "friction_angle_deg.TEST"
  /// for the angle of a test, or "scheme.NAME" for a constant of the particle method
  /// (soil/scheme.h). These settings override `soil_values`.
  std::vector<std::pair<std::string, std::string>> settings;
  /// Texts of the rig's parameters, keyed by Parameter::name. A list of values, separated by
  /// commas, makes a sweep axis.
  std::map<std::string, std::string> geometry;
  /// Cell sizes to run with [m]; if empty, the rig's default cell size.
  std::vector<double> cells;
  /// If true, every report includes the soil's energy account.
  bool energy = false;
  /// Callback for progress reports within a run, as Setup::progress. May be empty.
  std::function<void(double share)> progress;
};

/// One run of an experiment plan.
struct PlannedRun {
  /// Value of the run on each sweep axis, in the order of ExperimentPlan::axes.
  std::vector<double> at;
  /// Complete and checked inputs of the run.
  Setup setup;
};

/// All runs of an experiment: one for each combination of the axis values. Without axes, there is
/// one run.
struct ExperimentPlan {
  /// Quantities that have more than one value, with these values.
  std::vector<SweepAxis> axes;
  /// Runs in the order of `combinations`: the last axis varies fastest.
  std::vector<PlannedRun> runs;
};

/// Returns `soil` with the changes of `experiment`: first `soil_values`, of which only the first
/// value of each list counts, then `settings`. Values that depend on others by default are updated,
/// unless they are given: residual cohesion, loose cohesion and Young's modulus.
/// @throws InputError for an unknown name, a text that is not a number, two friction angles, or one
/// above the limit in plane strain.
scene::Soil soil_of(const Experiment& experiment, scene::Soil soil);

/// Returns the plan of all runs of `experiment` on `rig`. All runs are checked here, so an error in
/// the last run is reported before the first run starts.
/// @throws InputError with option, value and the most similar allowed value.
ExperimentPlan plan_of(const Rig& rig, const Experiment& experiment, device::Device& device);

}  // namespace navvy::lab
