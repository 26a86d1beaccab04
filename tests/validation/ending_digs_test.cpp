// SPDX-License-Identifier: Apache-2.0
// Digs in difficult ground, in separate scenes (digs/), end by themselves at the requested depth.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "record/summary.h"
#include "validation/report.h"
#include "validation/scenes.h"
#include "validation/trench_measure.h"

namespace navvy::validation {
namespace {

constexpr const char* kFolder = "tests/validation/digs";
constexpr const char* kSource = "digs that end [docs/validation.md, Whole digs]";

/// Records the tilt of the machine while its bucket is in the ground.
class ScoopWatch {
 public:
  void look(const session::Session& session) {
    const std::string phase = session.phase(0);
    const Mat3 R = session.world().machines().at(0).link(0).pose().linear();
    // Angle of the base's x axis above the horizontal: these digs are ahead of the machine.
    const double pitch = std::asin(R(2, 0)), time = session.world().time();
    if (phase == "penetrate" && last_ != phase) start_ = pitch;
    if (phase == "penetrate" || phase == "drag" || phase == "curl")
      rise_ = std::max(rise_, pitch - start_);
    if (phase == "curl" && last_ != phase) curl_start_ = time;
    if (phase == "curl") longest_curl_ = std::max(longest_curl_, time - curl_start_);
    last_ = phase;
  }
  double rise() const { return degrees(rise_); }
  double longest_curl() const { return longest_curl_; }

 private:
  std::string last_;
  double start_ = 0, rise_ = 0, curl_start_ = 0, longest_curl_ = 0;
};

/// Returns a value of a step's account; NaN if it is missing, which fails every tolerance.
double value_of(const control::StepReport& step, const std::string& name) {
  for (const control::Measurement& one : step.measurements)
    if (one.name == name) return one.value;
  return std::nan("");
}

struct DigCase {
  const char* name;
  const char* file;
  std::vector<std::string> settings;
  int most_cycles;
};
void PrintTo(const DigCase& c, std::ostream* out) { *out << c.file; }

class EndingDigs : public testing::TestWithParam<DigCase> {};

TEST_P(EndingDigs, ReachTheirDepthAndStop) {
  const DigCase& c = GetParam();
  const scene::Scene description = load_scene(c.file, c.settings, kFolder);
  session::Session session(description, shared_device());
  ScoopWatch watch;
  while (!session.done()) {
    session.step();
    watch.look(session);
  }
  const control::Dig dig = dig_step(description);
  const TrenchMeasure trench = measure(session.world().ground(), dig);
  expect_between("the program's end [s]", session.world().time(), 10,
                 description.recording.duration - 1, kSource);
  expect_between("cycles", static_cast<double>(session.cycles().size()), 3, c.most_cycles, kSource);
  expect_between("design volume removed, share", trench.inside_volume / trench.design_volume, 0.85,
                 1.0, "the trench [docs/validation.md, Whole digs]");
  // The run's report agrees: "finished" only for a dig that reached its depth.
  const session::ProgramReport program = session.programs().at(0);
  const auto reported_dig =
      std::find_if(program.list.begin(), program.list.end(),
                   [](const control::StepReport& step) { return step.element == "dig"; });
  ASSERT_NE(reported_dig, program.list.end());
  EXPECT_EQ(reported_dig->state, control::StepState::kDone)
      << session::report_line(program, "the machine");
  EXPECT_TRUE(session.complete()) << session::report_line(program, "the machine");
  EXPECT_FALSE(session.fell_short());
  EXPECT_NEAR(value_of(*reported_dig, "depth_m"), dig.depth, 1e-12);
  // A dig of half the depth was once reported as finished; at least half of the length has that
  // depth.
  EXPECT_GT(value_of(*reported_dig, "depth_reached_m"), 0.75 * dig.depth);
  EXPECT_LT(value_of(*reported_dig, "volume_left_m3"),
            0.15 * value_of(*reported_dig, "design_volume_m3"));
  expect_between("nose's rise in a scoop [deg]", watch.rise(), 0, 3, kSource);
  expect_between("longest curl [s]", watch.longest_curl(), 1, 6, kSource);
  expect_between("ledger error [units]",
                 static_cast<double>(session.world().soil().mass_ledger().error), 0, 0, kSource);
  expect_between("shell crossings",
                 static_cast<double>(session.world().soil().counts().shell_crossings), 0, 0,
                 kSource);
}

INSTANTIATE_TEST_SUITE_P(
    Digs, EndingDigs,
    testing::Values(DigCase{"SoftFront", "soft_front.sdf", {}, 20},
                    DigCase{"DrySand", "dry_sand.sdf", {}, 40},
                    DigCase{"Uphill", "slope.sdf", {}, 20},
                    DigCase{"Downhill", "slope.sdf", {"ground.slope.angle_deg=-12"}, 20},
                    DigCase{"Clay", "clay.sdf", {}, 25}, DigCase{"Deep", "deep.sdf", {}, 40}),
    [](const auto& tested) { return tested.param.name; });

TEST(DrySand, SupportsAnIdleMachineAndLetsItDriveAway) {
  const char* source = "a machine on dry sand [docs/machines.md, ruts]";
  session::Session session(load_scene("sand_drive.sdf", {}, kFolder), shared_device());
  const heightfield::Ground& ground = session.world().ground();
  const auto lowest = [&] {
    double out = 0;
    for (int iy = 0; iy < ground.ny(); ++iy)
      for (int ix = 0; ix < ground.nx(); ++ix)
        out = std::max(out, ground.start_height(ix, iy) - ground.height(ix, iy));
    return out;
  };
  run_to(session, 3);
  const double early = lowest();
  run_to(session, 29.9);
  expect_between("lowest rut, idle for 30 s [m]", lowest(), 0.10, 0.16, source);
  expect_between("sinks from 3 s to 30 s [m]", lowest() - early, 0, 0.001, source);
  expect_between("earth moved by an idle machine [m3]",
                 record::measure_earthwork(session.world()).bank_volume, 0, 0.02, source);
  while (!session.done()) session.step();
  const auto& recording = session.world().description().recording;
  // 30 s at rest, 1 s after the end.
  expect_between("12 m of dry sand take [s]", session.world().time() - 30 - recording.settle, 10,
                 20, source);
  expect_between("ledger error [units]",
                 static_cast<double>(session.world().soil().mass_ledger().error), 0, 0, source);
}

}  // namespace
}  // namespace navvy::validation
