// SPDX-License-Identifier: Apache-2.0
// Level ground at rest.
#include "lab/report.h"

namespace navvy::lab {
namespace {

TEST(LabRest, StressIsTheWeightAbove) {
  const Report report = run_rig("rest", {{"width", 2.0}, {"depth", 0.6}, {"time", 0.6}});
  EXPECT_EQ(misses(report), "");
  EXPECT_EQ(report.ledger_error, 0);
}

}  // namespace
}  // namespace navvy::lab
