// SPDX-License-Identifier: Apache-2.0
#include "tolerances/tolerances.h"
#include "paths.h"

#include <gtest/gtest-spi.h>

#include <cmath>
#include <fstream>
#include <limits>
#include <sstream>

namespace navvy::tolerances {
namespace {

const std::string kHead =
    "Prose.\n\n| Test | Quantity | Now | Tolerance | Cause |\n|---|---|---|---|---|\n";

/// A result of 12 % with a tolerance of 10 %, and one of 27 with 28.3 or more.
const KnownDeviation kAbove = {"T.a", "over-dug", {0.11, 0.13}, {0, 0.10}, "because"};
const KnownDeviation kBelow = {"T.b", "angle", {26.5, 27.5}, {28.3, 36}, "because"};

TEST(Judge, TheToleranceDecidesWithoutARow) {
  EXPECT_EQ(judge(nullptr, 0.10, {0, 0.10}), Verdict::kMet);
  EXPECT_EQ(judge(nullptr, 0.11, {0, 0.10}), Verdict::kOutOfTolerance);
  EXPECT_EQ(judge(nullptr, std::nan(""), {0, 0.10}), Verdict::kOutOfTolerance);
}

TEST(Judge, AKnownDeviationWithinItsRowDoesNotFail) {
  EXPECT_EQ(judge(&kAbove, 0.12, {0, 0.10}), Verdict::kKnownDeviation);
  EXPECT_EQ(judge(&kBelow, 27, {28.3, 36}), Verdict::kKnownDeviation);
}

TEST(Judge, AWorseResultAndNotANumberFail) {
  EXPECT_EQ(judge(&kAbove, 0.131, {0, 0.10}), Verdict::kWorse);
  EXPECT_EQ(judge(&kBelow, 26.4, {28.3, 36}), Verdict::kWorse);
  EXPECT_EQ(judge(&kBelow, 36.1, {28.3, 36}), Verdict::kWorse) << "beyond the other bound";
  EXPECT_EQ(judge(&kAbove, -0.01, {0, 0.10}), Verdict::kWorse) << "beyond the other bound";
  EXPECT_EQ(judge(&kAbove, std::nan(""), {0, 0.10}), Verdict::kWorse);
}

TEST(Judge, AToleranceNewlyMetFailsUntilTheTableIsUpdated) {
  EXPECT_EQ(judge(&kAbove, 0.09, {0, 0.10}), Verdict::kNewlyMet);
  EXPECT_EQ(judge(&kBelow, 28.3, {28.3, 36}), Verdict::kNewlyMet);
}

TEST(Judge, ASmallerDeviationIsStillADeviation) {
  EXPECT_EQ(judge(&kAbove, 0.105, {0, 0.10}), Verdict::kBetterDeviation);
  EXPECT_EQ(judge(&kBelow, 28, {28.3, 36}), Verdict::kBetterDeviation);
}

TEST(Judge, AToleranceThatDiffersFromTheTableFails) {
  EXPECT_EQ(judge(&kAbove, 0.12, {0, 0.15}), Verdict::kToleranceMoved);
  EXPECT_EQ(judge(&kAbove, 0.12, {0.01, 0.10}), Verdict::kToleranceMoved);
  EXPECT_EQ(judge(&kBelow, 27, {28.301, 36}), Verdict::kKnownDeviation)
      << "the table has fewer digits";
}

TEST(KnownDeviations, ReadsRowsAndOpenSides) {
  const auto rows =
      parse_known_deviations(kHead + "| S/A.b/c | x, y | 1.4 .. 1.5 | 1.6 .. | too small |\n");
  ASSERT_EQ(rows.size(), 1u);
  EXPECT_EQ(rows[0].test, "S/A.b/c");
  EXPECT_EQ(rows[0].quantity, "x, y");
  EXPECT_DOUBLE_EQ(rows[0].now.high, 1.5);
  EXPECT_DOUBLE_EQ(rows[0].tolerance.low, 1.6);
  EXPECT_EQ(rows[0].tolerance.high, std::numeric_limits<double>::infinity());
  EXPECT_EQ(rows[0].reason, "too small");
}

TEST(KnownDeviations, RefusesRowsThatWouldHideSomething) {
  const std::string good = "| A.b | x | 1.4 .. 1.5 | 1.6 .. 2 | why |\n";
  for (const char* bad :
       {"| A.b | x | 1.4 .. 1.7 | 1.6 .. 2 | why |\n",  // overlaps its tolerance
        "| A.b | x | 1.4 .. 1.5 | 1.6 .. 2 | |\n",      // no reason
        "| A.b | x | 1.4 | 1.6 .. 2 | why |\n",         // no band
        "| A.b | x | 1.4 .. | 1.6 .. 2 | why |\n",      // everything above 1.4
        "| A.b | x | a .. b | 1.6 .. 2 | why |\n", "| A.b | 1.4 .. 1.5 | 1.6 .. 2 | why |\n"})
    EXPECT_THROW(parse_known_deviations(kHead + bad), std::runtime_error) << bad;
  EXPECT_THROW(parse_known_deviations(kHead + good + good), std::runtime_error) << "twice";
}

TEST(KnownDeviations, TheTableOfThisTreeIsValid) {
  std::ifstream file(navvy::source_dir() + "/tests/tolerances/known_deviations.md");
  std::stringstream text;
  text << file.rdbuf();
  EXPECT_GT(parse_known_deviations(text.str()).size(), 0u);
}

TEST(ExpectBetween, FailsTheTestOutsideItsTolerance) {
  EXPECT_NONFATAL_FAILURE(expect_between("quantity", 2, 0, 1, "here"), "is outside 0 .. 1");
  expect_between("quantity", 0.5, 0, 1, "here");
}

}  // namespace
}  // namespace navvy::tolerances
