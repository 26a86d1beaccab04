// SPDX-License-Identifier: Apache-2.0
// Short versions of the granular rigs, seconds each. The tolerances are the rigs' own. If a short
// version is outside its tolerance, the test says so and checks what holds, and docs/validation.md
// lists the deviation.
#include "core/error.h"
#include "core/math.h"
#include "lab/run_rig.h"
#include "lab/theory/formulas.h"

namespace navvy::lab {
namespace {

TEST(LabColumn, PlaneRunOutIsWithinToleranceAndThatOfRigidSandIsNot) {
  // 30 cells, as the tolerance requires.
  const Report report = run_rig("column", {});
  EXPECT_EQ(outside_tolerance(report), "");
  EXPECT_EQ(measured(report, "particles through a plate"), 0);
  EXPECT_EQ(report.ledger_error, 0);
  // Negative control: nearly rigid sand must be distinguished, already at 10 cells.
  const Report control =
      run_rig("column", {{"l0", 0.5}}, [](lab::Setup& s) { s.soil.friction_angle = radians(50); });
  EXPECT_LT(measured(control, "run-out over L0"), 1.2);
  // The tolerance does not apply to the control, which has other sand and fewer cells.
  EXPECT_EQ(outside_tolerance(control), "");
  EXPECT_FALSE(control.find("run-out over L0")->judged());
}

TEST(LabColumn, RoundColumnSpreadsToAllSides) {
  // 12 cells of radius, where the tolerance requires 30: the run-out is too short, as in the plane
  // case.
  const Report report = run_rig("column", {{"shape", 1}, {"l0", 0.6}});
  EXPECT_GT(measured(report, "run-out over L0"), 0.7);
  EXPECT_LT(measured(report, "run-out over L0"), 1.5);
  EXPECT_EQ(report.ledger_error, 0);
}

TEST(LabCone, GentleHeapStandsAndSteepOneSlides) {
  const Report report = run_rig("cone", {});
  EXPECT_EQ(outside_tolerance(report), "");
}

TEST(LabPour, GentleHeapAssumesItsAngleOfRepose) {
  // Half the base and little rest: outside the validity of the tolerance, inside its range for the
  // angle.
  const Report report = run_rig("pour", {{"base", 0.8}, {"rest", 1}});
  const Quantity* angle = report.find("repose after rest");
  ASSERT_NE(angle, nullptr);
  EXPECT_FALSE(angle->judged());
  EXPECT_NEAR(angle->low, 28.3, 1e-9);
  EXPECT_NEAR(angle->high, 33, 1e-9);
  EXPECT_GE(measured(report, "repose after pouring"), angle->low);
  EXPECT_LE(measured(report, "repose after pouring"), 36);
  EXPECT_EQ(report.ledger_error, 0);
}

TEST(LabSlope, FlowsAndStopsAtTheAngleOfItsFriction) {
  const Report report = run_rig("slope", {{"length", 14}, {"halvings", 2}});
  // Found to within 1 degree.
  EXPECT_EQ(outside_tolerance(report), "");
}

TEST(LabSlide, BlocksObeyCoulomb) {
  const Report report = run_rig("slide", {{"time", 0.6}});
  EXPECT_EQ(outside_tolerance(report), "");
  // The force on the plate is Coulomb's up to the rounding of floats.
  EXPECT_NEAR(measured(report, "soil block, shear without adhesion x area over normal force"),
              std::tan(radians(20)), 1e-3);
}

TEST(LabThrow, SoilOpensFliesAndLands) {
  const Report report = run_rig("throw", {{"edge", 1}, {"height", 0.5}, {"rest", 1}});
  EXPECT_GT(measured(report, "opened in flight to, V/V0"), 1.5);
  EXPECT_EQ(measured(report, "particles through a wall"), 0);
  EXPECT_EQ(report.ledger_error, 0);
}

TEST(LabSwell, TippedLoadLeavesTheBucketAndRests) {
  const Report report = run_rig("swell", {{"volume", 0.4}, {"rest", 1}});
  EXPECT_EQ(measured(report, "particles through the shell"), 0);
  EXPECT_EQ(measured(report, "left in the bucket"), 0);
  EXPECT_EQ(report.ledger_error, 0);
}

TEST(LabRigs, RepeatBitIdentically) {
  const auto change = [](lab::Setup& s) { s.soil.friction_angle = radians(34); };
  const std::map<std::string, double> small = {{"width", 1.2}, {"depth", 0.4}, {"time", 0.1}};
  EXPECT_EQ(run_rig("rest", small, change).state_hash, run_rig("rest", small, change).state_hash);
}

TEST(LabRigs, DescribeTheirMeasurementsAndRefuseInvalidSetups) {
  for (const Rig& rig : rigs()) {
    EXPECT_FALSE(rig.summary.empty()) << rig.name;
    EXPECT_FALSE(rig.drawing.empty()) << rig.name;
    for (const Parameter& p : rig.parameters)
      EXPECT_FALSE(p.help.empty() && p.choices.empty()) << rig.name << " " << p.name;
  }
  lab::Setup setup = default_setup(find_rig("rest"), test_device());
  setup.soil.bank_density = -1;
  EXPECT_THROW(find_rig("rest").run(setup), InputError);
}

TEST(Lab, RejectsMeaninglessGeometryAndReportsEveryFault) {
  lab::Setup setup = default_setup(find_rig("column"), test_device());
  EXPECT_NO_THROW(check(find_rig("column"), setup));
  setup.geometry["l0"] = -1;
  setup.geometry["shape"] = 7;
  setup.geometry["time"] = std::nan("");
  setup.geometry["a"] = 0;
  try {
    check(find_rig("column"), setup);
    FAIL() << "accepted";
  } catch (const InputError& error) {
    EXPECT_EQ(error.faults().size(), 4u) << error.what();
  }
  for (const Rig& rig : rigs())
    EXPECT_NO_THROW(check(rig, default_setup(rig, test_device()))) << rig.name;
}

}  // namespace
}  // namespace navvy::lab
