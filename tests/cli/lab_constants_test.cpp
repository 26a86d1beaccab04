// SPDX-License-Identifier: Apache-2.0
// `navvy lab constants` and `navvy lab RIG --set scheme.NAME=VALUE`.
#include <gtest/gtest.h>

#include <string>

#include "cli/program_run.h"

namespace navvy {
namespace {

using LabConstants = test::ProgramRun;

TEST_F(LabConstants, AreListedWithDefaultAndRange) {
  ASSERT_EQ(run({"lab", "constants"}), 0) << complained();
  for (const char* text : {"mixing_strain", "0.025", "volume_damping", "0 .. 30"})
    EXPECT_NE(said().find(text), std::string::npos) << said();
}

TEST_F(LabConstants, AreRefusedWithTheNearestNameAndTheRange) {
  EXPECT_NE(run({"lab", "shear", "--set", "scheme.mixing_strian=1"}), 0);
  EXPECT_NE(complained().find("did you mean 'mixing_strain'"), std::string::npos) << complained();
  EXPECT_NE(run({"lab", "shear", "--set", "scheme.closing_share=2"}), 0);
  EXPECT_NE(complained().find("within 0 .. 1"), std::string::npos) << complained();
  EXPECT_NE(run({"lab", "shear", "--set", "scheme.closing_share=much"}), 0);
  EXPECT_NE(complained().find("must be a number"), std::string::npos) << complained();
}

}  // namespace
}  // namespace navvy
