// SPDX-License-Identifier: Apache-2.0
#include "lab/rig.h"

#include <cmath>

#include "core/edit_distance.h"
#include "core/error.h"
#include "scene/soil_values.h"

namespace navvy::lab {
namespace {

/// Returns a fault without file and line: it is on the command line or in a caller's setup.
Fault fault(const std::string& where, const std::string& value, const std::string& rule,
            const std::string& remedy) {
  return Fault{Fault::Severity::kError, "", 0, where, value, rule, remedy};
}

/// Returns a remedy; empty without candidates.
std::string did_you_mean(const std::vector<std::string>& names, const std::string& wanted) {
  return names.empty() ? "" : "did you mean '" + nearest_name(names, wanted) + "'?";
}

/// Returns "lab column --l0", or "lab column" for the rig as a whole. A setup made by hand may have
/// no rig.
std::string place(const Rig* rig, const std::string& parameter = "") {
  return "lab" + (rig == nullptr ? "" : " " + rig->name) +
         (parameter.empty() ? "" : " --" + parameter);
}

Fault no_such_parameter(const Rig* rig, const std::string& name,
                        const std::vector<std::string>& known) {
  return fault(place(rig), name, "there is no parameter of this name", did_you_mean(known, name));
}

std::vector<std::string> words(const Parameter& parameter) {
  std::vector<std::string> out;
  for (const Choice& choice : parameter.choices) out.push_back(choice.word);
  return out;
}

}  // namespace

double Setup::operator[](const std::string& name) const {
  // A misspelt name in a rig itself ends here, too, at its first run.
  const auto found = geometry.find(name);
  if (found != geometry.end()) return found->second;
  std::vector<std::string> names;
  for (const auto& [known, value] : geometry) names.push_back(known);
  throw InputError(no_such_parameter(rig, name, names));
}

int Setup::whole(const std::string& name) const {
  return static_cast<int>(std::lround((*this)[name]));
}

bool Setup::is(const std::string& name, const std::string& word) const {
  const double value = (*this)[name];
  const Parameter* parameter = rig == nullptr ? nullptr : rig->find(name);
  // A word that no choice has is an error of the caller, not a "no".
  if (parameter != nullptr)
    for (const Choice& choice : parameter->choices)
      if (choice.word == word) return choice.number == value;
  throw InputError(fault(place(rig, name), word, "no choice of this parameter",
                         parameter == nullptr ? "" : did_you_mean(words(*parameter), word)));
}

const Parameter* Rig::find(const std::string& parameter) const {
  for (const Parameter& known : parameters)
    if (known.name == parameter) return &known;
  return nullptr;
}

Report Rig::run(const Setup& setup) const {
  // Checked here and not only by the program: tests and bindings run rigs as well.
  check(*this, setup);
  return experiment(setup);
}

const Rig& find_rig(const std::string& name) {
  std::vector<std::string> names;
  for (const Rig& rig : rigs()) {
    if (rig.name == name) return rig;
    names.push_back(rig.name);
  }
  throw InputError(
      fault(place(nullptr), name, "there is no rig of this name", did_you_mean(names, name)));
}

Setup default_setup(const Rig& rig, device::Device& device) {
  Setup setup;
  setup.rig = &rig;
  setup.device = &device;
  setup.soil = rig.default_soil;
  setup.cell = rig.default_cell;
  // Every parameter is in the setup from the start, so a rig never has to test whether it was
  // given.
  for (const Parameter& parameter : rig.parameters)
    setup.geometry[parameter.name] = parameter.value;
  return setup;
}

// Collects all faults before it throws.
void set_written(Setup& setup, const std::map<std::string, std::string>& written) {
  std::vector<Fault> faults;
  for (const auto& [name, text] : written) {
    const Parameter* parameter = setup.rig->find(name);
    if (parameter == nullptr) {
      std::vector<std::string> names;
      for (const Parameter& known : setup.rig->parameters) names.push_back(known.name);
      faults.push_back(no_such_parameter(setup.rig, name, names));
      continue;
    }
    // check() tests ranges, also of values set in other ways.
    const std::optional<double> value = parameter->read(text);
    if (value)
      setup.geometry[name] = *value;
    else
      faults.push_back(fault(place(setup.rig, name), text, parameter->rule(),
                             did_you_mean(words(*parameter), text)));
  }
  if (!faults.empty()) throw InputError(faults);
}

void check(const Rig& rig, const Setup& setup) {
  // All faults at once, including those of the soil: a rig may compute without a site.
  std::vector<Fault> faults = scene::check_soil(setup.soil);
  for (const Parameter& p : rig.parameters) {
    const double value = setup[p.name];
    if (p.allows(value)) continue;
    const std::string unit = p.unit.empty() ? "" : " " + p.unit;
    faults.push_back(
        fault(place(&rig, p.name), short_text(value), p.rule(),
              (p.help.empty() ? "" : p.help + ", ") + "by default " + p.text(p.value) + unit));
  }
  if (!faults.empty()) throw InputError(faults);
}

}  // namespace navvy::lab
