// SPDX-License-Identifier: Apache-2.0
// The table of scheme constants: names, ranges, and the build options that kernels get.
#include "soil/scheme.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <set>
#include <string>

#include "core/error.h"

namespace navvy::soil {
namespace {

/// The message of the error that setting a constant throws; empty when it is set.
std::string refusal(const std::string& name, double value) {
  SchemeConstants scheme;
  try {
    set_scheme_constant(scheme, name, value);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(SchemeConstants, HaveUniqueNamesADescriptionAndADefaultWithinTheirRange) {
  std::set<std::string> names;
  for (const SchemeConstant& row : scheme_constants()) {
    EXPECT_TRUE(names.insert(row.name).second) << row.name;
    EXPECT_STRNE(row.help, "") << row.name;
    EXPECT_LE(row.low, row.standard()) << row.name;
    EXPECT_GE(row.high, row.standard()) << row.name;
    EXPECT_EQ(refusal(row.name, row.low), "");
    EXPECT_EQ(refusal(row.name, row.high), "");
  }
  EXPECT_GT(names.size(), 25u);
}

TEST(SchemeConstants, AreSetByTheirNames) {
  SchemeConstants scheme;
  set_scheme_constant(scheme, "mixing_strain", 0.1);
  EXPECT_EQ(scheme.mixing_strain, 0.1);
  EXPECT_EQ(scheme.crowding_strain, kScheme.crowding_strain);
}

TEST(SchemeConstants, RejectAnUnknownNameWithTheNearest) {
  const std::string text = refusal("mixing_strian", 0.1);
  EXPECT_NE(text.find("did you mean 'mixing_strain'?"), std::string::npos) << text;
  EXPECT_NE(text.find("navvy lab constants"), std::string::npos) << text;
}

TEST(SchemeConstants, RejectAValueOutsideTheRangeWithRangeAndDefault) {
  for (const double value : {-0.1, 1.5, std::numeric_limits<double>::quiet_NaN()}) {
    const std::string text = refusal("closing_share", value);
    EXPECT_NE(text.find("scheme.closing_share"), std::string::npos) << text;
    EXPECT_NE(text.find("within 0 .. 1"), std::string::npos) << text;
    EXPECT_NE(text.find("the default is 0.166667"), std::string::npos) << text;
  }
}

TEST(SchemeConstants, ReachKernelsAsTheFloatsThatStoodThereAsLiterals) {
  const std::vector<std::string> options = scheme_options(kScheme);
  const std::set<std::string> given(options.begin(), options.end());
  EXPECT_EQ(options.size(), scheme_constants().size() + 1);
  // 10, 1.1, 2.6 and 4 / 3 to the last bit.
  EXPECT_EQ(given.count("-DSCHEME_volume_damping=(0x1.4p+3f)"), 1u);
  EXPECT_EQ(given.count("-DSCHEME_max_closing_ratio=(0x1.19999ap+0f)"), 1u);
  EXPECT_EQ(given.count("-DSCHEME_contact_bearing_offset=(0x1.4cccccp+1f)"), 1u);
  EXPECT_EQ(given.count("-DSCHEME_contact_touch=(0x1.555556p+0f)"), 1u);
}

}  // namespace
}  // namespace navvy::soil
