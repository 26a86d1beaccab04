// SPDX-License-Identifier: Apache-2.0
// The shipped excavator digs with other buckets, each by one line of the scene.
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "folder.h"
#include "process.h"
#include "text_of.h"

namespace navvy {
namespace {

/// Returns the summary of two scoops in loam with a shipped bucket.
nlohmann::json dig_with(const std::string& bucket) {
  const test::Folder folder;
  std::ofstream(folder / "dig.sdf") << R"(<sdf version="1.9" xmlns:navvy="navvy">
<world name="dig"><navvy:soil ref="loam"/>
<navvy:ground><size_m>24 20</size_m></navvy:ground>
<include><uri>model://ew180</uri><name>digger</name><pose>-3 0 0 0 0 0</pose>
<navvy:bucket ref=")" << bucket << R"("/>
<navvy:program><dig><from_m>6 0</from_m><to_m>3 0</to_m><depth_m>0.6</depth_m>
<dump_at_m>-1 6</dump_at_m><max_cycles>2</max_cycles></dig></navvy:program></include>
<navvy:recording><duration_s>120</duration_s></navvy:recording></world></sdf>)";
  test::Command dig{NAVVY_PROGRAM,
                    {"run", folder / "dig.sdf", "--no-render", "--quiet", "--out", folder / "out"},
                    {}};
  dig.err = folder / "err";
  EXPECT_EQ(test::wait_for(test::start(dig)), 0) << test::text_of(dig.err);
  return nlohmann::json::parse(test::text_of(folder / "out/summary.json"));
}

TEST(SwappedBucket, DigsByItsOwnWidthAndCapacity) {
  // Buckets of 0.60 m and 1.80 m in width.
  const nlohmann::json narrow = dig_with("trenching_0_60"), wide = dig_with("ditching_1_80");
  for (const nlohmann::json& summary : {narrow, wide}) {
    EXPECT_EQ(summary.at("mass_ledger").at("error_units"), 0);
    EXPECT_EQ(summary.at("cycles"), 2);
    const double fill = summary.at("score").at("machines").at(0).at("fill_factor_mean");
    EXPECT_GT(fill, 0.7) << summary.at("payload_kg").dump();
    EXPECT_LT(fill, 1.1) << summary.at("payload_kg").dump();
  }
  EXPECT_GT(wide.at("payload_kg").at(0), 2 * narrow.at("payload_kg").at(0).get<double>());
}

}  // namespace
}  // namespace navvy
