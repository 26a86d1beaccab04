// SPDX-License-Identifier: Apache-2.0
// What is asked of a rig, and the runs that follow from it.
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

/// A soil value that an experiment may change by itself.
struct SoilOption {
  const char* name;            ///< of the option, ends in its unit: "phi-deg"
  const char* help;            ///< one line, with the unit in brackets
  double scene::Soil::*value;  ///< null for an option that sets more than one number
  double factor = 1;           ///< SI value = given value x factor
};

/// Returns every such value, in the order of the help.
const std::vector<SoilOption>& soil_options();

/// The request of a person: a soil, changes to it, and values of the rig. Everything that may be a
/// list is an axis of a sweep when it has more than one value.
struct Experiment {
  std::optional<scene::Soil> soil;  ///< none: the rig's own
  /// Values by SoilOption::name, in the unit of the option.
  std::map<std::string, std::vector<double>> soil_values;
  /// Numbers of the soil by their names in scene files (scene/soil_values.h), in that unit, or
  /// constants of the particle scheme as "scheme.NAME" (soil/scheme.h). They win over
  /// `soil_values`.
  std::vector<std::pair<std::string, std::string>> settings;
  /// Parameter values as written, keyed by Parameter::name; a list is separated by commas.
  std::map<std::string, std::string> geometry;
  /// Edges of the soil cells [m]; none: the rig's own.
  std::vector<double> cells;
  bool energy = false;                         ///< report the soil's energy account
  std::function<void(double share)> progress;  ///< as Setup::progress
};

/// One run of a plan.
struct PlannedRun {
  std::vector<double> at;  ///< its value on each axis
  Setup setup;
};

/// The axes of an experiment and a run for each combination of their values; without a list one
/// run.
struct ExperimentPlan {
  std::vector<SweepAxis> axes;
  std::vector<PlannedRun> runs;
};

/// Makes the soil of an experiment: `soil` with the first of each list of values, then the
/// settings. Values that follow others by default (residual and loose cohesion, stiffness) follow
/// the changes unless they are given. @throws InputError for an unknown name or text that is no
/// number.
scene::Soil soil_of(const Experiment& experiment, scene::Soil soil);

/// Makes and checks all runs, so that a fault of the last one shows before the first one runs.
/// @throws InputError naming the option, the value and the nearest that is allowed.
ExperimentPlan plan_of(const Rig& rig, const Experiment& experiment, device::Device& device);

}  // namespace navvy::lab
