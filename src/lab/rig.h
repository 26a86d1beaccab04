// SPDX-License-Identifier: Apache-2.0
// The virtual soil laboratory: rigs that measure one quantity of the soil, as a geotechnical
// laboratory does.
#pragma once

#include <functional>
#include <map>
#include <string>
#include <vector>

#include "lab/parameter.h"
#include "lab/report.h"
#include "scene/soil.h"

namespace navvy::device {
class Device;
}

namespace navvy::lab {

struct Rig;

/// What one experiment is made with. `geometry` holds every parameter of the rig (see
/// default_setup).
struct Setup {
  const Rig* rig = nullptr;  ///< whose parameters these are
  device::Device* device = nullptr;
  scene::Soil soil;
  double cell = 0.1;                       ///< [m]
  std::map<std::string, double> geometry;  ///< by Parameter::name
  /// The report shall tell the soil's energy, which takes time.
  bool energy = false;
  std::function<void(double share)> progress;  ///< called now and then with 0 .. 1; may be empty

  /// A parameter's value. @throws InputError naming the nearest parameter when the rig has none of
  /// this name.
  double operator[](const std::string& name) const;
  /// The same as a whole number, for counts.
  int whole(const std::string& name) const;
  /// Whether the choice `name` is the one of this word. @throws InputError for a word that is none
  /// of its choices.
  bool is(const std::string& name, const std::string& word) const;
};

/// A way of running a rig that is worth a line of its own, mostly one published experiment.
struct Example {
  std::string what;
  std::string arguments;  ///< of `navvy lab RIG`
};

/// One apparatus.
struct Rig {
  std::string name;     ///< one word, or two joined by '-'
  std::string summary;  ///< one line
  /// The rig in words, one paragraph: what stands where, what moves, what is read.
  std::string drawing;
  std::vector<Example> examples;
  std::vector<Parameter> parameters;
  scene::Soil default_soil;
  double default_cell = 0.1;                     ///< [m]
  Report (*experiment)(const Setup&) = nullptr;  ///< called by `run` after `check`
  /// Results that tables of many runs show (lab/sweep.h), the drawn one first.
  std::vector<std::string> headline = {};
  const Parameter* find(const std::string& parameter) const;  ///< null when there is none

  /// Checks the setup, then blocks until the experiment is over.
  /// @throws InputError for a setup that makes no sense, SimulationError when the soil stops
  /// itself.
  Report run(const Setup& setup) const;
};

/// Every rig, in the order in which a reader meets them.
const std::vector<Rig>& rigs();
/// @throws InputError naming the nearest rig.
const Rig& find_rig(const std::string& name);
/// Default soil, cell and geometry.
Setup default_setup(const Rig& rig, device::Device& device);
/// Sets parameters as a person wrote them: numbers, or the words of choices.
/// @throws InputError with every name that the rig does not have and every text that is no value,
/// each with the nearest that is. What a number may be is for `check` to say.
void set_written(Setup& setup, const std::map<std::string, std::string>& written);
/// @throws InputError with every parameter outside its range or choices: rig, parameter, value,
/// rule, and its default.
void check(const Rig& rig, const Setup& setup);

}  // namespace navvy::lab
