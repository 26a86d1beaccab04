// SPDX-License-Identifier: Apache-2.0
// Sweeps over lists of values: the runs, the table, the plot. No experiment runs here.
#include "lab/sweep.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/error.h"

namespace navvy::lab {
namespace {

/// Two speeds at two steps; the result is 10 v + step.
Sweep four_runs() {
  Sweep out;
  out.axes = {{"speed", "m/s", {0.05, 0.3}}, {"courant", "", {0.5, 0.25}}};
  for (const std::vector<double>& at : combinations(out.axes)) {
    SweepRun run;
    run.at = at;
    run.report.note("noise", 1, "");
    run.report.add("force", 10 * at[0] + at[1], "N", 2, 1, 3, "");
    out.runs.push_back(run);
  }
  return out;
}

Rig rig_with_headline() {
  Rig rig;
  rig.name = "blade";
  rig.headline = {"force", "not there"};
  return rig;
}

TEST(Sweep, RunsEveryCombinationLastAxisFastest) {
  const auto all = combinations({{"a", "", {1, 2}}, {"b", "", {3, 4, 5}}});
  ASSERT_EQ(all.size(), 6u);
  EXPECT_EQ(all[1], (std::vector<double>{1, 4}));
  EXPECT_EQ(all[5], (std::vector<double>{2, 5}));
  EXPECT_EQ(combinations({}).size(), 1u);
}

TEST(Sweep, SplitsListsAtCommasAndRefusesEmptyParts) {
  EXPECT_EQ(listed("--speed", "0.05,0.3"), (std::vector<std::string>{"0.05", "0.3"}));
  EXPECT_EQ(listed("--shape", "plane"), (std::vector<std::string>{"plane"}));
  for (const char* text : {"", "1,", ",1", "1,,2"})
    EXPECT_THROW(listed("--speed", text), InputError) << text;
}

TEST(Sweep, TableHasAxesHeadlineAndDeviations) {
  const auto table = table_of(rig_with_headline(), four_runs());
  ASSERT_EQ(table.size(), 5u);
  EXPECT_EQ(table[0], (std::vector<std::string>{"speed [m/s]", "courant", "force [N]", "steps", "s",
                                                "tolerances"}));
  // 10 x 0.05 + 0.5, at the end of the tolerance.
  EXPECT_EQ(table[1][2], "1");
  EXPECT_EQ(table[1].back(), "");
  EXPECT_EQ(table[2][2], "0.75");
  EXPECT_EQ(table[2].back(), "outside");
  EXPECT_EQ(text_of({{"a", "long"}, {"100", "b"}}), "  a  long\n100     b\n");
}

TEST(Sweep, PictureHasALineForEachStepOverTheSpeeds) {
  const Plot plot = plot_of(rig_with_headline(), four_runs());
  EXPECT_EQ(plot.x_label, "speed [m/s]");
  EXPECT_EQ(plot.y_label, "force [N]");
  ASSERT_EQ(plot.lines.size(), 2u);
  EXPECT_EQ(plot.lines[0].name, "courant 0.5");
  EXPECT_EQ(plot.lines[0].x, (std::vector<double>{0.05, 0.3}));
  EXPECT_NEAR(plot.lines[1].y[1], 3.25, 1e-12);
  EXPECT_EQ(plot.expected, (std::vector<double>{2}));
  ASSERT_EQ(plot.tolerances.size(), 1u);
  EXPECT_EQ(plot.tolerances[0].second, 3);
}

TEST(SvgPlot, TicksAreRoundAndCoverTheRange) {
  EXPECT_EQ(round_ticks(0, 10, 5), (std::vector<double>{0, 2, 4, 6, 8, 10}));
  const std::vector<double> small = round_ticks(0.93, 1.07, 6);
  EXPECT_NEAR(small.front(), 0.95, 1e-12);
  EXPECT_NEAR(small.back(), 1.05, 1e-12);
  EXPECT_EQ(round_ticks(3, 3, 5), (std::vector<double>{3}));
}

TEST(SvgPlot, OmitsNonFiniteValuesAndEscapesItsTexts) {
  Plot plot;
  plot.title = "a < b & c";
  plot.lines = {{"one", {1, 2, 3}, {5, std::nan(""), 7}}};
  const std::string svg = svg_of(plot);
  EXPECT_NE(svg.find("a &lt; b &amp; c"), std::string::npos);
  EXPECT_EQ(svg.find("nan"), std::string::npos);
  // Two markers on the line and one in the legend.
  std::size_t marks = 0;
  for (std::size_t i = 0; (i = svg.find("<circle", i)) != std::string::npos; ++i) ++marks;
  EXPECT_EQ(marks, 3u);
  EXPECT_NE(svg_of(Plot{}).find("</svg>"), std::string::npos);
}

}  // namespace
}  // namespace navvy::lab
