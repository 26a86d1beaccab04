// SPDX-License-Identifier: Apache-2.0
// The granular rigs at the sizes their gates are given for, and at half the cell. A miss fails unless it is in
// gates/known_misses.md.
#include "lab/report.h"
#include "validation/report.h"

namespace navvy::lab {
namespace {

struct Case {
  const char* name;
  const char* rig;
  std::map<std::string, double> geometry;
  double cell = 0;  ///< 0: the rig's default
};
void PrintTo(const Case& c, std::ostream* out) { *out << c.rig; }

class GranularLab : public testing::TestWithParam<Case> {};

TEST_P(GranularLab, MeetsItsGates) {
  const Case& c = GetParam();
  const Report report = run_rig(c.rig, c.geometry, [&](lab::Setup& s) {
    if (c.cell > 0) s.cell = c.cell;
  });
  validation::expect_gates(report);
}

// The soils of `swell` and `throw` are the rigs' defaults: loam of swell 1.23, sand of none.
INSTANTIATE_TEST_SUITE_P(Rigs, GranularLab,
                         testing::Values(Case{"Rest", "rest", {}}, Case{"RestHalf", "rest", {}, 0.05},
                                         Case{"PlaneColumn", "column", {}},
                                         Case{"PlaneColumnHalf", "column", {}, 0.025},
                                         Case{"TallPlaneColumn", "column", {{"a", 5}, {"l0", 0.6}}, 0.02},
                                         Case{"RoundColumn", "column", {{"shape", 1}}},
                                         Case{"TallRoundColumn", "column", {{"shape", 1}, {"a", 3}, {"l0", 0.6}}, 0.02},
                                         Case{"Pour", "pour", {}}, Case{"PourHalf", "pour", {}, 0.05},
                                         Case{"PourCone", "pour", {{"shape", 1}}}, Case{"Heap", "cone", {}},
                                         Case{"HeapHalf", "cone", {}, 0.05}, Case{"Cone", "cone", {{"shape", 1}}},
                                         Case{"Slope", "slope", {}}, Case{"Slide", "slide", {}},
                                         Case{"SlideHalf", "slide", {}, 0.05}, Case{"Throw", "throw", {}},
                                         Case{"ThrowHalf", "throw", {}, 0.05}, Case{"Swell", "swell", {}},
                                         Case{"SwellHalf", "swell", {}, 0.05}),
                         [](const testing::TestParamInfo<Case>& tested) { return std::string(tested.param.name); });

}  // namespace
}  // namespace navvy::lab
