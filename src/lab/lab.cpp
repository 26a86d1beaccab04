// SPDX-License-Identifier: Apache-2.0
#include "lab/lab.h"

#include <algorithm>
#include <cmath>

#include "core/edit_distance.h"
#include "core/error.h"

namespace navvy::lab {
namespace {

/// The name of `names` most like `wanted`.
std::string nearest(const std::vector<std::string>& names, const std::string& wanted) {
  std::string best;
  std::size_t least = static_cast<std::size_t>(-1);
  for (const std::string& name : names) {
    const std::size_t distance = edit_distance(name, wanted);
    if (distance < least) least = distance, best = name;
  }
  return best;
}

InputError no_such(const std::string& kind, const std::string& name, const std::vector<std::string>& names) {
  return InputError(Fault{Fault::Severity::kError, "", 0, "lab " + kind, name, "there is no " + kind + " of this name",
                          "did you mean '" + nearest(names, name) + "'?"});
}

}  // namespace

double Setup::operator[](const std::string& name) const {
  const auto found = geometry.find(name);
  if (found != geometry.end()) return found->second;
  std::vector<std::string> names;
  for (const auto& [known, value] : geometry) names.push_back(known);
  throw no_such("parameter", name, names);
}

int Setup::whole(const std::string& name) const { return static_cast<int>(std::lround((*this)[name])); }

bool Quantity::has_gate() const { return !std::isnan(low) || !std::isnan(high); }

bool Quantity::missed() const {
  if (!has_gate()) return false;
  // Written so that a measured NaN misses.
  const bool above = std::isnan(low) || measured >= low, below = std::isnan(high) || measured <= high;
  return !(above && below) || std::isnan(measured);
}

void Report::add(const std::string& name, double measured, const std::string& unit, double expected, double low,
                 double high, const std::string& source) {
  results.push_back({name, measured, unit, expected, low, high, source});
}

void Report::note(const std::string& name, double measured, const std::string& unit, const std::string& source) {
  results.push_back({name, measured, unit, kNone, kNone, kNone, source});
}

const Quantity* Report::find(const std::string& name) const {
  for (const Quantity& quantity : results)
    if (quantity.name == name) return &quantity;
  return nullptr;
}

const Rig& find_rig(const std::string& name) {
  std::vector<std::string> names;
  for (const Rig& rig : rigs()) {
    if (rig.name == name) return rig;
    names.push_back(rig.name);
  }
  throw no_such("rig", name, names);
}

Setup default_setup(const Rig& rig, device::Device& device) {
  Setup setup;
  setup.device = &device;
  setup.soil = rig.default_soil;
  setup.cell = rig.default_cell;
  for (const Parameter& parameter : rig.parameters) setup.geometry[parameter.name] = parameter.value;
  return setup;
}

void check(const Rig& rig, const Setup& setup) {
  // A choice says what 0 and 1 mean; some lengths and times may be left out, the others a rig divides by.
  const auto is_choice = [](const Parameter& p) {
    return p.unit.empty() && (p.help.rfind("0:", 0) == 0 || p.help.rfind("1:", 0) == 0);
  };
  const std::vector<std::string> may_be_zero = {"rest",  "wait",   "drop",  "offset",      "beside", "back",
                                                "front", "ahead",  "below", "tilt-deg",    "search", "press",
                                                "turn",  "height", "slip",  "gate-percent"};
  std::vector<Fault> faults;
  for (const Parameter& p : rig.parameters) {
    const double value = setup[p.name];
    std::string rule;
    if (!std::isfinite(value))
      rule = "a finite number";
    else if (is_choice(p) && value != 0 && value != 1)
      rule = p.help;
    else if (p.value >= 0 && p.name != "travel" && p.name != "slip" && value < 0)
      rule = "not less than 0";
    else if (p.value > 0 && value == 0 && !is_choice(p) &&
             std::find(may_be_zero.begin(), may_be_zero.end(), p.name) == may_be_zero.end())
      rule = "more than 0";
    if (!rule.empty())
      faults.push_back(Fault{Fault::Severity::kError, "", 0, "lab " + rig.name + " --" + p.name, std::to_string(value),
                             rule, p.help + ", e.g. " + std::to_string(p.value) + " " + p.unit});
  }
  if (!faults.empty()) throw InputError(faults);
}

}  // namespace navvy::lab
