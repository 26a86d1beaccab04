// SPDX-License-Identifier: Apache-2.0
// Ranges of parameters, and how texts are read.
#include "lab/parameter.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/error.h"

namespace navvy::lab {
namespace {

TEST(ParameterRange, ExcludesOpenEndsAndIncludesClosedOnes) {
  EXPECT_FALSE(above(0).contains(0));
  EXPECT_TRUE(above(0).contains(1e-9));
  EXPECT_TRUE(at_least(0).contains(0));
  EXPECT_FALSE(at_least(0).contains(-1e-9));
  EXPECT_TRUE(between(-1, 0.95).contains(-1));
  EXPECT_TRUE(between(-1, 0.95).contains(0.95));
  EXPECT_FALSE(between(-1, 0.95).contains(0.96));
  ParameterRange open = between(0, 1);
  open.open_most = true;
  EXPECT_FALSE(open.contains(1));
  EXPECT_TRUE(any().contains(-7));
}

TEST(ParameterRange, AcceptsOnlyFiniteNumbersAndWholeCounts) {
  for (const ParameterRange& range : {any(), above(0), at_least(0)}) {
    EXPECT_FALSE(range.contains(std::numeric_limits<double>::infinity()));
    EXPECT_FALSE(range.contains(std::nan("")));
  }
  EXPECT_TRUE(count_from(1).contains(3));
  EXPECT_FALSE(count_from(1).contains(0));
  EXPECT_FALSE(count_from(1).contains(2.5));
}

TEST(ParameterRange, DescribesItsRule) {
  EXPECT_EQ(above(0).text(), "above 0");
  EXPECT_EQ(at_least(0).text(), "at least 0");
  EXPECT_EQ(between(15, 150).text(), "15 .. 150");
  EXPECT_EQ(count_from(1).text(), "a whole number, at least 1");
  EXPECT_EQ(any().text(), "a finite number");
  ParameterRange open = between(0, 1);
  open.open_most = true;
  EXPECT_EQ(open.text(), "at least 0 and below 1");
}

TEST(Parameter, ReadsNumbersAndTheWordsOfItsChoices) {
  const Parameter shape =
      choice("shape", "round", "", {{"plane", 0, "a block"}, {"round", 1, "a cylinder"}});
  EXPECT_EQ(shape.value, 1);
  EXPECT_EQ(shape.read("plane"), 0);
  // The number is accepted for the choice, too.
  EXPECT_EQ(shape.read("1"), 1);
  EXPECT_FALSE(shape.read("square"));
  EXPECT_EQ(shape.text(0), "plane");
  EXPECT_EQ(shape.rule(), "plane or round");
  EXPECT_TRUE(shape.allows(1));
  EXPECT_FALSE(shape.allows(2));
  const Parameter depth{"depth", 0.8, "m", "of the pit", above(0)};
  EXPECT_EQ(depth.read("1e-3"), 1e-3);
  EXPECT_EQ(depth.read("+2"), 2);
  // Read, though not allowed.
  EXPECT_EQ(depth.read("-2"), -2);
  for (const char* text : {"", "2m", "much", "+"}) EXPECT_FALSE(depth.read(text)) << text;
  EXPECT_EQ(depth.rule(), "above 0 m");
}

TEST(Parameter, DefaultThatIsNoChoiceIsRefused) {
  EXPECT_THROW(choice("shape", "square", "", {{"plane", 0, ""}}), InputError);
}

}  // namespace
}  // namespace navvy::lab
