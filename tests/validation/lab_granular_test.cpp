// SPDX-License-Identifier: Apache-2.0
// The granular rigs at the sizes for which their tolerances are given, and at half the cell. A
// deviation fails unless it is in tolerances/known_deviations.md.
#include "validation/courant.h"
#include "validation/rig_case.h"
#include "values.h"

namespace navvy::validation {
namespace {

using Case = RigCase;

class GranularLab : public testing::TestWithParam<RigCase> {};

TEST_P(GranularLab, MeetsItsTolerances) { expect_tolerances(GetParam()); }

// A fast stream spreads by its momentum, which a static angle does not describe: values without a
// tolerance.
TEST(FastPour, SpreadsByItsMomentum) {
  const lab::Report report = lab::run_rig("pour", {{"speed", 0.8}, {"drop", 4}});
  EXPECT_FALSE(report.find("repose after rest")->judged());
  for (const char* quantity : {"repose after pouring", "repose after rest"})
    print_value("poured at 0.8 m/s from 4 cells, " + std::string(quantity) + " [deg]",
                lab::measured(report, quantity), "no tolerance", "navvy lab pour");
  EXPECT_EQ(report.ledger_error, 0);
}

// Dug and poured soil is loose and remoulded: loam of 6 kPa that kept more than its loose cohesion
// would form heaps of 50 to 70 deg.
TEST(PouredLoam, FormsHeapsLikeSpoil) {
  const lab::Report report = lab::run_rig("pour", {}, [](lab::Setup& s) {
    s.soil.name = "loam";
    s.soil.bank_density = 1540, s.soil.swell = 1.23, s.soil.friction_angle = radians(30);
    s.soil.cohesion = 6000, s.soil.residual_cohesion = 1500, s.soil.loose_cohesion = 300;
    s.soil.young_modulus = 1.2e6;
  });
  expect_between("poured loam, slope after rest [deg]", lab::measured(report, "repose after rest"),
                 35, 42,
                 "spoil heaps lie at 34 .. 45 deg [docs/validation.md, Swell, pouring and heaps]");
  expect_between("poured loam, lost at rest [deg]", lab::measured(report, "angle lost at rest"),
                 -kNoLimit, 1, "no creep [docs/validation.md, Swell, pouring and heaps]");
  EXPECT_EQ(report.ledger_error, 0);
}

// The soils of `swell` and `throw` are the rigs' defaults, loam of swell 1.23 and sand of none,
// unless stated.
const std::map<std::string, double> kHalfStep = {{"courant", kHalfCourant}};
const SoilChange kDrySand = {.phi_degrees = 33, .cohesion = 0, .swell = 1.13, .bank_density = 1600};

INSTANTIATE_TEST_SUITE_P(
    Rigs, GranularLab,
    testing::Values(Case{"Rest", "rest", {}}, Case{"RestHalf", "rest", {}, 0.05},
                    Case{"PlaneColumn", "column", {}}, Case{"PlaneColumnHalf", "column", {}, 0.025},
                    Case{"PlaneColumnHalfStep", "column", kHalfStep},
                    Case{"TallPlaneColumn", "column", {{"a", 5}, {"l0", 0.6}}, 0.02},
                    Case{"RoundColumn", "column", {{"shape", 1}}},
                    Case{"TallRoundColumn", "column", {{"shape", 1}, {"a", 3}, {"l0", 0.6}}, 0.02},
                    Case{"Pour", "pour", {}}, Case{"PourHalf", "pour", {}, 0.05},
                    Case{"PourCone", "pour", {{"shape", 1}}}, Case{"Heap", "cone", {}},
                    Case{"HeapHalf", "cone", {}, 0.05}, Case{"Cone", "cone", {{"shape", 1}}},
                    Case{"Slope25", "slope", {}, lab::kNone, {.phi_degrees = 25}},
                    Case{"Slope30", "slope", {}, lab::kNone, {.phi_degrees = 30}},
                    Case{"Slope", "slope", {}},
                    Case{"Slope40", "slope", {}, lab::kNone, {.phi_degrees = 40}},
                    Case{"Slide", "slide", {}}, Case{"SlideHalf", "slide", {}, 0.05},
                    Case{"Throw", "throw", {}}, Case{"ThrowHalf", "throw", {}, 0.05},
                    Case{"ThrowHalfStep", "throw", kHalfStep}, Case{"Swell", "swell", {}},
                    Case{"SwellHalfStep", "swell", kHalfStep}, Case{"SwellHalf", "swell", {}, 0.05},
                    Case{"SwellDrySand", "swell", {}, lab::kNone, kDrySand},
                    Case{"SwellDrySandHalf", "swell", {}, 0.05, kDrySand}),
    case_name);

}  // namespace
}  // namespace navvy::validation
