// SPDX-License-Identifier: Apache-2.0
// A foreign crawler excavator with placeholders for masses digs once its masses are filled in.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <numeric>
#include <vector>

#include "folder.h"
#include "process.h"
#include "scene_io/crawler.h"
#include "text_of.h"

namespace navvy {
namespace {

TEST(ImportedExcavator, DigsThreeBucketsAfterItsMassesAreFilledIn) {
  const test::Folder folder;
  scene_io::testing::write_crawler(folder);
  std::ofstream(folder / "masses.csv") << scene_io::testing::kCrawlerMasses;
  test::Command import{NAVVY_PROGRAM,
                       {"import", folder / "crawler.urdf", "--masses", folder / "masses.csv",
                        "--out", folder / "crawler"},
                       {}};
  import.err = folder / "err";
  ASSERT_EQ(test::wait_for(test::start(import)), 0) << test::text_of(import.err);
  std::ofstream(folder / "dig.sdf") << R"(<sdf version="1.9" xmlns:navvy="navvy">
<world name="dig"><navvy:soil ref="loam"/>
<navvy:ground><size_m>24 20</size_m><depth_m>3</depth_m></navvy:ground>
<include><uri>crawler/model.sdf</uri><name>digger</name><pose>-4 0 0 0 0 0</pose>
<navvy:joint name="j1"><initial_deg>43</initial_deg></navvy:joint>
<navvy:joint name="j2"><initial_deg>-126</initial_deg></navvy:joint>
<navvy:joint name="j3"><initial_deg>-75</initial_deg></navvy:joint>
<navvy:program><dig><from_m>3.5 0</from_m><to_m>0.5 0</to_m><depth_m>0.8</depth_m>
<dump_at_m>-3 6</dump_at_m><max_cycles>3</max_cycles></dig></navvy:program></include>
<navvy:recording><duration_s>150</duration_s></navvy:recording></world></sdf>)";
  test::Command dig{NAVVY_PROGRAM,
                    {"run", folder / "dig.sdf", "--no-render", "--quiet", "--out", folder / "out"},
                    {}};
  dig.err = folder / "err";
  EXPECT_EQ(test::wait_for(test::start(dig)), 0) << test::text_of(dig.err);
  const auto summary = nlohmann::json::parse(test::text_of(folder / "out/summary.json"));
  EXPECT_EQ(summary.at("status"), "finished");
  for (const auto& program : summary.at("programs"))
    EXPECT_EQ(program.at("state"), "done") << program.dump(1);
  EXPECT_EQ(summary.at("mass_ledger").at("error_units"), 0);
  EXPECT_EQ(summary.at("cycles"), 3);
  const auto payloads = summary.at("payload_kg").get<std::vector<double>>();
  ASSERT_EQ(payloads.size(), 3u);
  EXPECT_GT(std::accumulate(payloads.begin(), payloads.end(), 0.0) / 3, 300)
      << summary.at("payload_kg").dump();
}

}  // namespace
}  // namespace navvy
