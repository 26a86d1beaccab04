// SPDX-License-Identifier: Apache-2.0
// Force on the edge of a thin plate pushed into the ground (navvy lab tip), against bearing
// capacity.
#include <string>

#include "lab/soils.h"
#include "scene_io/shipped.h"
#include "validation/rig_case.h"
#include "values.h"

namespace navvy::validation {
namespace {

constexpr const char* kSource = "[Prandtl 1920] [docs/tools.md, edges]";

struct TipCase {
  const char* soil;
  double thickness;  ///< of the plate [m]
};
void PrintTo(const TipCase& c, std::ostream* out) { *out << c.soil; }

scene::Soil soil_of(const std::string& name) {
  if (name == "Sand") return lab::clean_sand(35);
  if (name == "Loam") return scene_io::shipped_soil("loam", "soil");
  scene::Soil clay = lab::cohesive(0, 30e3);
  clay.residual_cohesion = 20e3;
  return clay;
}

class TipForce : public testing::TestWithParam<TipCase> {};

TEST_P(TipForce, IsTheBearingCapacityOfItsSoilInBothCells) {
  const TipCase& c = GetParam();
  double coarse = 0;
  for (const double cell : {0.1, 0.05}) {
    const lab::Report report =
        lab::run_rig("tip", {{"thickness", c.thickness}}, [&](lab::Setup& s) {
          s.cell = cell;
          s.soil = soil_of(c.soil);
        });
    const std::string cells = ", cells of " + lab::short_text(cell) + " m";
    const lab::Quantity& force = *report.find("tip force");
    expect_between("tip force" + cells + " [kN]", force.measured, force.low, force.high, kSource,
                   force.expected);
    print_value("part on the edge" + cells + " [kN]", lab::measured(report, "part on the edge"),
                "no tolerance", kSource);
    expect_between("force held over force in motion" + cells,
                   lab::measured(report, "force held over force in motion"), 0.8, kNoLimit,
                   "at rest is at rest [docs/tools.md, edges]");
    EXPECT_EQ(report.ledger_error, 0);
    EXPECT_EQ(lab::measured(report, "particles through the plate"), 0);
    EXPECT_LT(lab::measured(report, "momentum residual"), 1e-5);
    if (coarse == 0)
      coarse = force.measured;
    else
      expect_between("force in cells of 0.05 m / of 0.1 m", force.measured / coarse, 0.85, 1.15,
                     kSource, 1);
  }
}

TEST(TipOfABlock, AgreesBetweenCells) {
  // Two and four cells thick.
  double coarse = 0;
  for (const double cell : {0.1, 0.05}) {
    const lab::Report report =
        lab::run_rig("tip", {{"thickness", 0.2}, {"block", 1}}, [&](lab::Setup& s) {
          s.cell = cell;
          s.soil = soil_of("Loam");
        });
    const lab::Quantity& force = *report.find("tip force");
    const std::string name =
        "block of 0.2 m, cells of " + lab::short_text(cell) + " m, force on its end [kN]";
    // The ratio judges two cells.
    if (coarse == 0)
      print_value(name, force.measured, "no tolerance", kSource);
    else
      expect_between(name, force.measured, force.low, force.high, kSource, force.expected);
    EXPECT_EQ(lab::measured(report, "part on the edge"), 0);
    if (coarse == 0)
      coarse = force.measured;
    else
      expect_between("block of 0.2 m, force in cells of 0.05 m / of 0.1 m", force.measured / coarse,
                     0.85, 1.15, kSource, 1);
  }
}

INSTANTIATE_TEST_SUITE_P(Plates, TipForce,
                         testing::Values(TipCase{"Sand", 0.03}, TipCase{"Sand", 0.06},
                                         TipCase{"Loam", 0.03}, TipCase{"Loam", 0.06},
                                         TipCase{"Clay", 0.03}, TipCase{"Clay", 0.06}),
                         [](const auto& tested) {
                           return std::string(tested.param.soil) +
                                  (tested.param.thickness < 0.05 ? "30" : "60");
                         });

}  // namespace
}  // namespace navvy::validation
