// SPDX-License-Identifier: Apache-2.0
// Level ground at rest.
#include "lab/run_rig.h"

namespace navvy::lab {
namespace {

TEST(LabRest, StressIsTheWeightAbove) {
  const Report report = run_rig("rest", {});
  EXPECT_EQ(outside_tolerance(report), "");
  EXPECT_EQ(report.ledger_error, 0);
}

}  // namespace
}  // namespace navvy::lab
