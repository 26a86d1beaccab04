// SPDX-License-Identifier: Apache-2.0
#include "lab/experiment.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

#include "core/edit_distance.h"
#include "core/error.h"
#include "core/math.h"
#include "lab/soils.h"
#include "scene/soil_values.h"
#include "soil/scheme.h"

namespace navvy::lab {
namespace {

constexpr double kDegree = kPi / 180;

InputError refused(const std::string& where, const std::string& value, const std::string& rule,
                   const std::string& remedy) {
  return InputError(Fault{Fault::Severity::kError, "", 0, where, value, rule, remedy});
}

/// Options that give a friction angle, with the test that measured it.
/// The same tests as scene::kFrictionTests, under names for a command line.
constexpr std::pair<const char*, scene::FrictionTest> kAngleOptions[] = {
    {"phi-deg", scene::FrictionTest::kPlaneStrain},
    {"direct-shear-deg", scene::FrictionTest::kDirectShear},
    {"triaxial-deg", scene::FrictionTest::kTriaxial},
    {"repose-deg", scene::FrictionTest::kRepose}};
const std::string kAngleName = "friction_angle_deg";

const std::string kSchemePrefix = "scheme.";

/// Returns true for a setting of the particle scheme, false for one of the soil.
bool is_scheme_setting(const std::string& name) { return name.rfind(kSchemePrefix, 0) == 0; }

/// Returns the number of a setting. All of the text must be the number: 0.02m is a mistake.
double number_of(const std::string& name, const std::string& text) {
  double number = 0;
  const char* end = text.data() + text.size();
  const auto [stop, failed] = std::from_chars(text.data(), end, number);
  if (failed != std::errc() || stop != end)
    throw refused("--set " + name, text, "must be a number", "");
  return number;
}

/// Sets the friction angle by friction_angle_deg.TEST.
void set_angle(scene::Soil& soil, const std::string& name, const std::string& text) {
  const std::string wanted = name.substr(kAngleName.size() + 1);
  std::vector<std::string> names;
  for (const auto& [test_name, test] : scene::kFrictionTests) {
    names.emplace_back(test_name);
    if (wanted == test_name) return set_friction(soil, test, number_of(name, text) * kDegree);
  }
  throw refused("--set", name, "unknown test '" + wanted + "'", suggestion(wanted, names));
}

/// Sets a number of the soil by its name in scene files, in that file's unit.
void set_value(scene::Soil& soil, const std::string& name, const std::string& text) {
  // A bare angle is the law's own, as in scene files, whatever the soil's angle was measured by.
  if (name == kAngleName) soil.friction_test = scene::FrictionTest::kPlaneStrain;
  if (name.rfind(kAngleName + ".", 0) == 0) return set_angle(soil, name, text);
  std::vector<std::string> names;
  for (const scene::SoilValue& value : scene::soil_values(soil)) {
    names.emplace_back(value.name);
    if (name != value.name) continue;
    *value.value = number_of(name, text) * value.factor;
    return;
  }
  throw refused("--set", name,
                "must be a number of a soil, by its name in scene files, or scheme.NAME",
                "did you mean '" + nearest_name(names, name) + "'?");
}

/// Returns the given value of an option in SI units; kNone when it was not given.
double given(const Experiment& experiment, const std::string& name) {
  const auto values = experiment.soil_values.find(name);
  if (values == experiment.soil_values.end() || values->second.empty()) return kNone;
  for (const SoilOption& option : soil_options())
    if (name == option.name) return values->second.front() * option.factor;
  return kNone;
}

/// Takes the friction angle from the options, of which at most one may give it.
void take_friction(const Experiment& experiment, scene::Soil& soil) {
  std::string first;
  // At most one angle is accepted, as converting two could give contradictory strengths.
  for (const auto& [name, test] : kAngleOptions) {
    const double angle = given(experiment, name);
    if (std::isnan(angle)) continue;
    if (!first.empty())
      throw refused(std::string("--") + name, scene::short_text(angle / kDegree),
                    "the friction angle is given already by --" + first, "remove one of them");
    first = name;
    set_friction(soil, test, angle);
  }
}

/// Returns the shortest text that reads back as the same number.
/// A rounded text would run another value than the one that the table of the sweep shows.
std::string exact_text(double value) {
  std::array<char, 32> text{};
  return {text.data(), std::to_chars(text.data(), text.data() + text.size(), value).ptr};
}

/// An axis, and how one of its values gets into an experiment of single values.
struct Axis {
  SweepAxis axis;
  std::function<void(Experiment&, double)> put;
};

void add_geometry(std::vector<Axis>& axes, const Experiment& experiment, const Rig& rig) {
  // In the rig's own order: the first axis is the one that pictures are drawn over.
  for (const Parameter& parameter : rig.parameters) {
    const std::string& name = parameter.name;
    const auto written = experiment.geometry.find(name);
    if (written == experiment.geometry.end()) continue;
    const std::string where = "lab " + rig.name + " --" + name;
    const std::vector<std::string> parts = listed(where, written->second);
    // A single value is set by set_written and makes no axis.
    if (parts.size() < 2) continue;
    SweepAxis axis{name, parameter.unit, {}};
    for (const std::string& part : parts) {
      const std::optional<double> value = parameter.read(part);
      if (!value) throw refused(where, part, parameter.rule(), "");
      axis.values.push_back(*value);
    }
    axes.push_back(
        {axis, [name](Experiment& one, double value) { one.geometry[name] = exact_text(value); }});
  }
}

std::vector<Axis> axes_of(const Experiment& experiment, const Rig& rig) {
  std::vector<Axis> axes;
  add_geometry(axes, experiment, rig);
  if (experiment.cells.size() > 1)
    axes.push_back({{"cell", "m", experiment.cells},
                    [](Experiment& one, double value) { one.cells = {value}; }});
  for (const SoilOption& option : soil_options()) {
    const auto values = experiment.soil_values.find(option.name);
    if (values == experiment.soil_values.end() || values->second.size() < 2) continue;
    // The unit is part of the name of these options, as in phi-deg.
    axes.push_back({{option.name, "", values->second},
                    [name = std::string(option.name)](Experiment& one, double value) {
                      one.soil_values[name] = {value};
                    }});
  }
  return axes;
}

/// Makes the setup of one run: every value of `experiment` is a single one.
Setup setup_of(const Experiment& experiment, const Rig& rig, device::Device& device) {
  Setup setup = default_setup(rig, device);
  setup.soil = soil_of(experiment, experiment.soil.value_or(setup.soil));
  for (const auto& [name, text] : experiment.settings)
    if (is_scheme_setting(name))
      soil::set_scheme_constant(setup.scheme, name.substr(kSchemePrefix.size()),
                                number_of(name, text));
  if (!experiment.cells.empty()) setup.cell = experiment.cells.front();
  // Ranges are not checked here: some depend on the cell, and `check` sees the whole setup.
  set_written(setup, experiment.geometry);
  setup.energy = experiment.energy;
  setup.progress = experiment.progress;
  return setup;
}

}  // namespace

const std::vector<SoilOption>& soil_options() {
  using scene::Soil;
  static const std::vector<SoilOption> table = {
      {"phi-deg", "friction angle phi in plane strain, the law's own [deg]", nullptr, kDegree},
      {"direct-shear-deg", "friction angle of a direct shear test instead of phi [deg]", nullptr,
       kDegree},
      {"triaxial-deg", "friction angle of triaxial compression instead of phi [deg]", nullptr,
       kDegree},
      {"repose-deg", "angle of repose t instead of phi: sin phi = tan t [deg]", nullptr, kDegree},
      {"cohesion-pa", "cohesion c, also the residual cohesion unless the soil's is lower [Pa]",
       nullptr},
      {"density", "bank density [kg/m3]", &Soil::bank_density},
      {"young-pa", "Young's modulus, reduced for speed; by default at least 200 x cohesion [Pa]",
       &Soil::young_modulus},
      {"poisson", "Poisson's ratio [-]", &Soil::poisson},
      {"swell", "loose volume / bank volume [-]", &Soil::swell},
      {"dilatancy-deg", "dilatancy angle psi in bank state [deg]; needs a swell",
       &Soil::dilatancy_angle, kDegree},
      {"fast-phi-deg", "mu(I): friction angle of fast flow [deg]", &Soil::fast_friction_angle,
       kDegree},
      {"grain-m", "mu(I): grain diameter [m]", &Soil::grain_diameter},
      {"inertial-number", "mu(I): inertial number at half the growth [-]", &Soil::inertial_number},
      {"delta-deg", "friction angle of soil on tool [deg]", &Soil::tool_friction_angle, kDegree},
      {"adhesion-pa", "adhesion of soil on tool [Pa]", &Soil::adhesion},
  };
  return table;
}

scene::Soil soil_of(const Experiment& experiment, scene::Soil soil) {
  const double cohesion_before = soil.cohesion, residual_before = soil.residual_cohesion;
  take_friction(experiment, soil);
  const double cohesion = given(experiment, "cohesion-pa");
  if (!std::isnan(cohesion)) {
    // The old value is needed below: other values follow the cohesion only where they equalled it.
    const double before = std::exchange(soil.cohesion, cohesion);
    // A residual cohesion that equalled the cohesion follows it, and it never exceeds it.
    if (cohesion != before &&
        (soil.residual_cohesion == before || soil.residual_cohesion > cohesion))
      soil.residual_cohesion = cohesion;
  }
  for (const SoilOption& option : soil_options())
    if (const double value = given(experiment, option.name);
        option.value != nullptr && !std::isnan(value))
      soil.*option.value = value;
  for (const auto& [name, text] : experiment.settings)
    if (!is_scheme_setting(name)) set_value(soil, name, text);
  // After the dilatancy is known.
  if (auto refused = scene::follow_friction_test(soil)) {
    refused->element = std::string("lab friction angle, ") + scene::name_of(soil.friction_test);
    throw InputError(*refused);
  }
  // A value that is given is not adapted, even if it equals the one that it would follow.
  const auto is_set = [&](const std::string& name) {
    return std::any_of(experiment.settings.begin(), experiment.settings.end(),
                       [&](const auto& setting) { return setting.first == name; });
  };
  if (!is_set("loose_cohesion_pa")) scene::follow_residual_cohesion(soil, residual_before);
  if (!is_set("young_modulus_pa") && std::isnan(given(experiment, "young-pa")))
    scene::follow_cohesion(soil, cohesion_before);
  return soil;
}

ExperimentPlan plan_of(const Rig& rig, const Experiment& experiment, device::Device& device) {
  ExperimentPlan plan;
  const std::vector<Axis> axes = axes_of(experiment, rig);
  for (const Axis& one : axes) plan.axes.push_back(one.axis);
  for (const std::vector<double>& at : combinations(plan.axes)) {
    Experiment one = experiment;
    for (std::size_t i = 0; i < at.size(); ++i) axes[i].put(one, at[i]);
    plan.runs.push_back({at, setup_of(one, rig, device)});
    // All setups are checked before the first run, which may take minutes.
    check(rig, plan.runs.back().setup);
  }
  return plan;
}

}  // namespace navvy::lab
