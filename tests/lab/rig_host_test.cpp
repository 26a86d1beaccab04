// SPDX-License-Identifier: Apache-2.0
// The list of rigs, their parameters and examples, and errors of setups. No experiment runs here.
#include "lab/rig.h"

#include <gtest/gtest.h>

#include <cmath>
#include <sstream>

#include "core/error.h"
#include "lab/sweep.h"

namespace navvy::lab {
namespace {

/// default_setup without a device: nothing here runs.
Setup setup_of(const Rig& rig) {
  lab::Setup setup;
  setup.rig = &rig;
  for (const Parameter& p : rig.parameters) setup.geometry[p.name] = p.value;
  return setup;
}

/// Returns the message of the InputError that `call` throws.
template <class Call>
std::string refusal(const Call& call) {
  try {
    call();
  } catch (const InputError& error) {
    return error.what();
  }
  ADD_FAILURE() << "accepted";
  return "";
}

bool holds(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

TEST(Rig, DefaultsAreAllowedAndEveryParameterHasADescription) {
  for (const Rig& rig : rigs()) {
    EXPECT_NO_THROW(check(rig, setup_of(rig))) << rig.name;
    for (const Parameter& p : rig.parameters) {
      EXPECT_FALSE(p.help.empty() && p.choices.empty()) << rig.name << " " << p.name;
      // A default that is written and read again is unchanged.
      EXPECT_EQ(p.read(p.text(p.value)), p.value) << rig.name << " " << p.name;
    }
  }
}

TEST(Rig, TextsAreUnformattedForTheProgram) {
  for (const Rig& rig : rigs())
    for (const std::string& text : {rig.summary, rig.drawing}) {
      EXPECT_EQ(text.find('\n'), std::string::npos) << rig.name;
      EXPECT_EQ(text.find("  "), std::string::npos) << rig.name << ": " << text;
    }
}

TEST(Rig, ExamplesUseParametersItHasWithinTheirRanges) {
  for (const Rig& rig : rigs())
    for (const Example& example : rig.examples) {
      EXPECT_FALSE(example.what.empty()) << rig.name;
      lab::Setup setup = setup_of(rig);
      std::map<std::string, std::string> written;
      std::istringstream words(example.arguments);
      for (std::string option, value; words >> option >> value;) {
        ASSERT_EQ(option.rfind("--", 0), 0u) << rig.name << ": " << option;
        // The rest are options of the soil and of the program. Every value of a list must be valid:
        // the last is tried here.
        if (rig.find(option.substr(2)) != nullptr)
          written[option.substr(2)] = listed(option, value).back();
      }
      EXPECT_NO_THROW(set_written(setup, written)) << rig.name;
      EXPECT_NO_THROW(check(rig, setup)) << rig.name;
    }
}

TEST(Rig, ChoicesAreSelectedByWord) {
  const Rig& column = find_rig("column");
  lab::Setup setup = setup_of(column);
  EXPECT_TRUE(setup.is("shape", "plane"));
  set_written(setup, {{"shape", "round"}, {"a", "3"}});
  EXPECT_TRUE(setup.is("shape", "round"));
  EXPECT_EQ(setup["a"], 3);
  set_written(setup, {{"shape", "0"}});
  EXPECT_TRUE(setup.is("shape", "plane"));
  const std::string text = refusal([&] { setup.is("shape", "rond"); });
  EXPECT_TRUE(holds(text, "'round'")) << text;
}

TEST(Rig, RefusalsNameRigParameterValueRuleAndTheNearest) {
  const Rig& column = find_rig("column");
  lab::Setup setup = setup_of(column);
  setup.geometry["l0"] = -1;
  std::string text = refusal([&] { check(column, setup); });
  for (const char* part : {"column", "--l0", "-1", "above 0 m", "1.5 m"})
    EXPECT_TRUE(holds(text, part)) << text;
  setup.geometry["l0"] = 1;
  setup.geometry["shape"] = 7;
  // It checks before it runs.
  text = refusal([&] { column.run(setup); });
  for (const char* part : {"--shape", "7", "plane or round"})
    EXPECT_TRUE(holds(text, part)) << text;
  text = refusal([&] { set_written(setup, {{"shape", "plain"}, {"ll0", "1"}, {"gap", "wide"}}); });
  for (const char* part : {"'plane'", "'l0'", "--gap", "wide"})
    EXPECT_TRUE(holds(text, part)) << text;
  text = refusal([&] {
    check(find_rig("cycle"), [] {
      lab::Setup counts = setup_of(find_rig("cycle"));
      counts.geometry["cycles"] = 2.5;
      return counts;
    }());
  });
  EXPECT_TRUE(holds(text, "a whole number")) << text;
}

TEST(Rig, RefusesAnInvalidSoilEvenWithoutASimulation) {
  const Rig& wheel = find_rig("wheel");
  lab::Setup setup = setup_of(wheel);
  set_written(setup, {{"law", "yes"}});
  EXPECT_NO_THROW(check(wheel, setup));
  setup.soil.bekker_n = -1;
  setup.soil.janosi_k = 0;
  const std::string text = refusal([&] { wheel.run(setup); });
  for (const char* part : {"bekker_n", "-1", "janosi_k_m"}) EXPECT_TRUE(holds(text, part)) << text;
}

TEST(Rig, SuggestsTheNearestForUnknownNames) {
  EXPECT_TRUE(holds(refusal([] { find_rig("rets"); }), "'rest'"));
  lab::Setup setup;
  setup.geometry = {{"width", 1}, {"depth", 2}};
  EXPECT_EQ(setup["depth"], 2);
  EXPECT_TRUE(holds(refusal([&] { setup["dept"]; }), "'depth'"));
}

TEST(Quantity, FailsOutsideItsToleranceAndWhenItIsNotANumber) {
  EXPECT_FALSE((Quantity{"a", 2, "", kNone, kNone, kNone, ""}.outside_tolerance()));
  EXPECT_FALSE((Quantity{"a", 2, "", 2, 1.9, 2.1, ""}.outside_tolerance()));
  EXPECT_TRUE((Quantity{"a", 2.2, "", 2, 1.9, 2.1, ""}.outside_tolerance()));
  EXPECT_TRUE((Quantity{"a", kNone, "", 2, 1.9, kNone, ""}.outside_tolerance()));
  EXPECT_TRUE((Quantity{"a", 1, "", kNone, kNone, 0.5, ""}.outside_tolerance()));
  Report report;
  report.add("a", 2.2, "", 2, 1.9, 2.1, "").holds_for("sand", false);
  EXPECT_FALSE(report.outside_tolerance());
  EXPECT_TRUE(report.results[0].has_tolerance());
  EXPECT_FALSE(report.results[0].judged());
  EXPECT_EQ(report.results[0].range, "sand");
  report.add("b", 2.2, "", 2, 1.9, 2.1, "").holds_for("sand", true);
  EXPECT_TRUE(report.outside_tolerance());
}

}  // namespace
}  // namespace navvy::lab
