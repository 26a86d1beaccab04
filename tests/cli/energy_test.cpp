// SPDX-License-Identifier: Apache-2.0
// `navvy run --energy` writes the soil's energy account to the summary and gives bit-identical
// results.
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "cli/program_run.h"

namespace navvy {
namespace {

class Energy : public test::ProgramRun {
 protected:
  nlohmann::json dig(const std::vector<std::string>& more) {
    std::vector<std::string> arguments{"run", "bucket_path", "--no-render", "--out",
                                       out(), "--quiet",     "--duration",  "1.2"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    EXPECT_EQ(run(arguments), 0) << complained();
    return summary();
  }
};

TEST_F(Energy, OfADigIsInTheSummaryAndResultsAreBitIdentical) {
  const nlohmann::json with = dig({"--energy"});
  const nlohmann::json& energy = with.at("soil_energy_j");
  double spent = 0;
  for (const char* term : {"plastic", "viscous", "contact", "edge", "transfer", "mixing"})
    spent += energy.at(term).get<double>();
  const double supplied = energy.at("tools").get<double>() + energy.at("gravity").get<double>() +
                          energy.at("exchanged").get<double>();
  const double stored = energy.at("kinetic").get<double>() + energy.at("elastic").get<double>();
  EXPECT_GT(energy.at("tools").get<double>(), 0);
  EXPECT_LE(spent, supplied);
  EXPECT_NEAR(energy.at("residual").get<double>(), supplied - stored - spent, 1e-6 * supplied);
  EXPECT_LT(std::abs(energy.at("residual").get<double>()), 0.05 * supplied);
  EXPECT_TRUE(with.contains("energy_j")) << "the machine's own account remains";
  const nlohmann::json without = dig({});
  EXPECT_FALSE(without.contains("soil_energy_j"));
  EXPECT_EQ(with.at("state_hash"), without.at("state_hash"));
}

}  // namespace
}  // namespace navvy
